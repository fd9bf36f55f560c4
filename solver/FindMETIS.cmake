# METIS (nested dissection): the target METIS::METIS.
include(${CMAKE_CURRENT_LIST_DIR}/find_plain_library.cmake)
find_plain_library(METIS metis.h metis)
