# SCOTCH (graph partitioning): the target SCOTCH::SCOTCH. Of its two libraries for errors scotcherr goes on, scotcherrexit
# would end the program.
include(find_plain_library)
find_library(SCOTCH_ERROR_LIBRARY scotcherr)
mark_as_advanced(SCOTCH_ERROR_LIBRARY)
find_plain_library(SCOTCH scotch.h scotch PATH_SUFFIXES scotch)
if(SCOTCH_FOUND)
  set_target_properties(SCOTCH::SCOTCH PROPERTIES INTERFACE_LINK_LIBRARIES ${SCOTCH_ERROR_LIBRARY})
endif()
