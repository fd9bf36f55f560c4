# For find modules of libraries that bring no CMake package of their own: finds header and library of NAME and makes the
# target NAME::NAME. What follows LIBRARY goes to find_path(). A macro, as what the find modules set is theirs.
include(FindPackageHandleStandardArgs)
macro(find_plain_library NAME HEADER LIBRARY)
  find_path(${NAME}_INCLUDE_DIR ${HEADER} ${ARGN})
  find_library(${NAME}_LIBRARY ${LIBRARY})
  find_package_handle_standard_args(${NAME} REQUIRED_VARS ${NAME}_LIBRARY ${NAME}_INCLUDE_DIR)
  if(${NAME}_FOUND AND NOT TARGET ${NAME}::${NAME})
    add_library(${NAME}::${NAME} UNKNOWN IMPORTED)
    set_target_properties(${NAME}::${NAME} PROPERTIES IMPORTED_LOCATION ${${NAME}_LIBRARY}
                          INTERFACE_SYSTEM_INCLUDE_DIRECTORIES ${${NAME}_INCLUDE_DIR}
                          INTERFACE_INCLUDE_DIRECTORIES ${${NAME}_INCLUDE_DIR})
  endif()
  mark_as_advanced(${NAME}_INCLUDE_DIR ${NAME}_LIBRARY)
endmacro()
