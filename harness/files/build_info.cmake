# Writes the header that names the sources of this build. Run at every build, so that the manifest names the commit that
# was compiled and not the one that was configured; the file is touched only when something changed.
#
#   cmake -DSOURCE_DIR=... -DOUTPUT=... -DVERSION=... -DCOMPILE_FLAGS=... -DBUILD_TYPE=... -P build_info.cmake
cmake_minimum_required(VERSION 3.22)
set(GIT_HASH unknown)
set(GIT_DIRTY unknown)
find_program(GIT git)
if(GIT)
  execute_process(COMMAND ${GIT} rev-parse HEAD WORKING_DIRECTORY ${SOURCE_DIR}
                  RESULT_VARIABLE FAILED OUTPUT_VARIABLE HASH ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT FAILED)
    set(GIT_HASH ${HASH})
    execute_process(COMMAND ${GIT} status --porcelain WORKING_DIRECTORY ${SOURCE_DIR}
                    RESULT_VARIABLE FAILED OUTPUT_VARIABLE CHANGES ERROR_QUIET)
    if(NOT FAILED AND CHANGES STREQUAL "")
      set(GIT_DIRTY false)
    elseif(NOT FAILED)
      set(GIT_DIRTY true)
    endif()
  endif()
endif()

string(REPLACE "\\" "\\\\" COMPILE_FLAGS "${COMPILE_FLAGS}")
string(REPLACE "\"" "\\\"" COMPILE_FLAGS "${COMPILE_FLAGS}")
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#pragma once
#define CLEAVE_VERSION "@VERSION@"
#define CLEAVE_GIT_HASH "@GIT_HASH@"
#define CLEAVE_GIT_DIRTY "@GIT_DIRTY@"
#define CLEAVE_COMPILE_FLAGS "@COMPILE_FLAGS@"
#define CLEAVE_BUILD_TYPE "@BUILD_TYPE@"
]])
