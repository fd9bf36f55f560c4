# What find_package(cleave) reads in an installed copy: the targets cleave::partition and cleave::solver. Eigen is
# compiled in; OpenMP, CAMD and METIS are linked.
include(CMakeFindDependencyMacro)
list(PREPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})  # FindCAMD.cmake, FindMETIS.cmake
find_dependency(OpenMP COMPONENTS CXX)
find_dependency(CAMD)
find_dependency(METIS)
list(POP_FRONT CMAKE_MODULE_PATH)
include(${CMAKE_CURRENT_LIST_DIR}/cleaveTargets.cmake)
