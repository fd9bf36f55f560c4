# CAMD of SuiteSparse (minimum degree): the target CAMD::CAMD. Older systems have no CMake package of it.
include(${CMAKE_CURRENT_LIST_DIR}/find_plain_library.cmake)
find_plain_library(CAMD camd.h camd PATH_SUFFIXES suitesparse)
