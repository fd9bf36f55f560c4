# What find_package(cleave) reads in an installed copy: the targets cleave::partition and cleave::solver. Eigen is
# compiled in; OpenMP and CAMD are linked.
include(CMakeFindDependencyMacro)
list(PREPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})  # FindCAMD.cmake
find_dependency(OpenMP COMPONENTS CXX)
find_dependency(CAMD)
list(POP_FRONT CMAKE_MODULE_PATH)
include(${CMAKE_CURRENT_LIST_DIR}/cleaveTargets.cmake)
