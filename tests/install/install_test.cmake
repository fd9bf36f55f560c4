# Installs a build, builds the project of this folder against that copy and against the sources, runs its examples and
# compares what they print.
#
#   cmake -DBUILD=... -DSOURCE=... -DCONFIG=... -DWORK=... -P install_test.cmake
cmake_minimum_required(VERSION 3.22)

set(PARTITION_PRINTS "0 0 0 0 0 0
0 0 0 1 1 1
2 2 2 2 1 1
2 2 2 2 1 1
3 parts, 120 interface rows
")
set(SOLVER_PRINTS "10.8891 N s
10.7910 N s
9.8100 N s
ok, exact
")

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE CODE OUTPUT_VARIABLE TEXT ERROR_VARIABLE TEXT)
  if(NOT CODE EQUAL 0)
    message(FATAL_ERROR "${ARGV} ended with ${CODE}:\n${TEXT}")
  endif()
  set(TEXT "${TEXT}" PARENT_SCOPE)
endfunction()

function(expect PROGRAM PRINTS)
  run(${PROGRAM})
  if(NOT TEXT STREQUAL PRINTS)
    message(FATAL_ERROR "${PROGRAM} printed\n${TEXT}where expected was\n${PRINTS}")
  endif()
endfunction()

set(CONFIGURE ${CMAKE_COMMAND} -G Ninja -S ${CMAKE_CURRENT_LIST_DIR} -DCMAKE_BUILD_TYPE=${CONFIG})
file(REMOVE_RECURSE ${WORK})

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${WORK}/prefix/bin/cleave --version)
# The moved copy shows that nothing points back to where it was installed.
file(RENAME ${WORK}/prefix ${WORK}/moved)
run(${CONFIGURE} -B ${WORK}/installed -DCMAKE_PREFIX_PATH=${WORK}/moved)
if(NOT TEXT MATCHES "installed headers: 18\n")
  message(FATAL_ERROR "expected 18 installed headers:\n${TEXT}")
endif()
run(${CMAKE_COMMAND} --build ${WORK}/installed)
expect(${WORK}/installed/partition_example "${PARTITION_PRINTS}")
expect(${WORK}/installed/solver_example "${SOLVER_PRINTS}")

# Of the sources only what the examples need is compiled; nothing of the program is looked for. METIS and SCOTCH may be absent. Flags
# are those of whoever takes them in: here the ones that the compiler has done with soonest.
run(${CONFIGURE} -B ${WORK}/taken_in -DCLEAVE_SOURCE_DIR=${SOURCE} -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0
    -DCMAKE_DISABLE_FIND_PACKAGE_PkgConfig=TRUE
    -DCMAKE_DISABLE_FIND_PACKAGE_HDF5=TRUE -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=TRUE
    -DCMAKE_DISABLE_FIND_PACKAGE_GTest=TRUE -DCMAKE_DISABLE_FIND_PACKAGE_SCOTCH=TRUE
    -DCMAKE_DISABLE_FIND_PACKAGE_METIS=TRUE)
run(${CMAKE_COMMAND} --build ${WORK}/taken_in --target partition_example solver_example)
expect(${WORK}/taken_in/partition_example "${PARTITION_PRINTS}")
expect(${WORK}/taken_in/solver_example "${SOLVER_PRINTS}")
file(REMOVE_RECURSE ${WORK})
