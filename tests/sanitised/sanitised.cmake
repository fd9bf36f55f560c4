# What a build with sanitisers (presets asan and tsan) does otherwise with the tests; see README.md of this folder.
# Sets TEST_FILTER (of GoogleTest), TEST_PROPERTIES of all tests and, for asan, TEST_SHARDS. The second variable of their environment is a
# property of its own, because gtest_discover_tests takes lists apart.

# A finding ends the program, with a code that no test expects of a program that it starts.
if(CLEAVE_SANITIZE MATCHES "thread")
  set(PRESET tsan)
  # Archer: only with it does the sanitiser see how OpenMP orders its threads.
  list(GET OpenMP_CXX_LIBRARIES 0 OPENMP_LIBRARY)
  cmake_path(GET OPENMP_LIBRARY PARENT_PATH OPENMP_FOLDER)
  find_library(ARCHER archer HINTS ${OPENMP_FOLDER} REQUIRED)
  find_program(SYMBOLIZER NAMES llvm-symbolizer-14 llvm-symbolizer REQUIRED)
  set(TEST_PROPERTIES ENVIRONMENT_MODIFICATION "OMP_TOOL_LIBRARIES=set:${ARCHER}" ENVIRONMENT
      "TSAN_OPTIONS=halt_on_error=1:exitcode=66:allocator_may_return_null=1:ignore_noninstrumented_modules=1:external_symbolizer_path=${SYMBOLIZER}")
  set_source_files_properties(solver/allocation_counter.cpp PROPERTIES COMPILE_DEFINITIONS CLEAVE_THREAD_SANITISER)
else()
  set(PRESET asan)
  # A program with this sanitiser takes a fifth of a second to begin, which is longer than most tests.
  set(TEST_SHARDS 12)
  set(TEST_PROPERTIES ENVIRONMENT_MODIFICATION "UBSAN_OPTIONS=set:exitcode=66:print_stacktrace=1" ENVIRONMENT
      "ASAN_OPTIONS=exitcode=66:detect_stack_use_after_return=1:check_initialization_order=1:allocator_may_return_null=1")
endif()

# What is looked at is the program; to look for undefined behaviour in the tests too takes the compiler a third of its time.
set(TEST_COMPILE_OPTIONS -g0)
if(CLEAVE_SANITIZE MATCHES "undefined")
  list(APPEND TEST_COMPILE_OPTIONS -fno-sanitize=undefined,float-cast-overflow)
endif()

# sanitised_quickly_compiled(): what reads words and starts programs is not optimised, which takes the compiler two fifths of its
# time. After all targets.
function(sanitised_quickly_compiled)
  foreach(TARGET cleave_commands cleave cleave_without_libraries harness_tests)
    target_compile_options(${TARGET} PRIVATE -O0)
  endforeach()
endfunction()

# sanitised_shards(ROOM): the tests of a room, every TEST_SHARDS-th in one process.
function(sanitised_shards ROOM)
  foreach(SHARD RANGE 1 ${TEST_SHARDS})
    set(NAME ${ROOM}/${SHARD}_of_${TEST_SHARDS})
    math(EXPR INDEX "${SHARD} - 1")
    add_test(NAME ${NAME} COMMAND ${ROOM}_tests --gtest_filter=${TEST_FILTER})
    set_tests_properties(${NAME} PROPERTIES TIMEOUT 1800 ${TEST_PROPERTIES})
    set_property(TEST ${NAME} APPEND PROPERTY ENVIRONMENT GTEST_TOTAL_SHARDS=${TEST_SHARDS} GTEST_SHARD_INDEX=${INDEX})
  endforeach()
endfunction()

# Planted faults show that the sanitisers are there and that a finding fails.
add_executable(sanitised_tests ${CMAKE_CURRENT_LIST_DIR}/${PRESET}_faults_test.cpp)
target_link_libraries(sanitised_tests PRIVATE cleave_solver OpenMP::OpenMP_CXX GTest::gtest_main)
add_test(NAME planted_faults COMMAND sanitised_tests)
add_test(NAME scenes COMMAND ${CMAKE_COMMAND} -E env CLEAVE_BINARY_DIR=${CMAKE_BINARY_DIR} ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/scenes_test.py -v)
set_tests_properties(planted_faults scenes PROPERTIES TIMEOUT 1800 ${TEST_PROPERTIES})
set_tests_properties(scenes PROPERTIES COST 1000)  # the longest, so it begins first

set(LEFT_OUT ${CMAKE_CURRENT_LIST_DIR}/left_out.txt)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${LEFT_OUT})
file(STRINGS ${LEFT_OUT} LINES REGEX "^(${PRESET}|both) ")
list(TRANSFORM LINES REPLACE "^[a-z]+ +([^ ]+) .*" "\\1")
list(JOIN LINES ":" TEST_FILTER)
string(PREPEND TEST_FILTER "-")
