# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Installs the C++ package of a finished build into a prefix of its own, builds the program beside this file against it,
# and runs that: cmake -D BUILD=... -D GENERATOR=... -D CXX=... -D BUILD_TYPE=... -P run.cmake
set(place ${BUILD}/embed)
file(REMOVE_RECURSE ${place})
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${place}/prefix --component dev)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${place}/build -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX}
  -D CMAKE_BUILD_TYPE=${BUILD_TYPE} -D CMAKE_PREFIX_PATH=${place}/prefix)
run(${CMAKE_COMMAND} --build ${place}/build)
execute_process(COMMAND ${place}/build/embed ${place}/map COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE printed)
message("${printed}")
if(NOT printed MATCHES "^[1-9][0-9]* nodes, [1-9][0-9]* x [1-9][0-9]* cells, 1 location\n$")
  message(FATAL_ERROR "the program printed something else than what it should")
endif()
