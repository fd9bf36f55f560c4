# Several sources compiled as one, for which the compiler reads and instantiates headers once: those of every test program, and
# with CMAKE_UNITY_BUILD (preset asan) all of the project.
set(MOST_SOURCES_OF_A_UNIT 8)

# group_sources_in_units(): says which sources are in which unit. After all targets.
function(group_sources_in_units)
  execute_process(COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/units.py ${PROJECT_SOURCE_DIR} ${MOST_SOURCES_OF_A_UNIT}
                  OUTPUT_VARIABLE LINES OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE "\n" ";" LINES "${LINES}")
  set(FOLDERS ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/tests)
  foreach(LINE ${LINES})
    string(REPLACE " " ";" SOURCE_AND_UNIT ${LINE})
    list(GET SOURCE_AND_UNIT 0 SOURCE)
    list(GET SOURCE_AND_UNIT 1 UNIT)
    set_source_files_properties(${PROJECT_SOURCE_DIR}/${SOURCE} DIRECTORY ${FOLDERS} PROPERTIES UNITY_GROUP ${UNIT})
    if(CMAKE_UNITY_BUILD OR SOURCE MATCHES "^tests/")
      # A changed source may keep a name to itself that another of its unit has.
      set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${SOURCE})
    endif()
  endforeach()
  foreach(FOLDER ${FOLDERS})
    get_property(TARGETS DIRECTORY ${FOLDER} PROPERTY BUILDSYSTEM_TARGETS)
    set_target_properties(${TARGETS} PROPERTIES UNITY_BUILD_MODE GROUP)
  endforeach()
endfunction()
