# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Installs the C++ package of a finished build into a prefix of its own, builds the program beside this file and the first
# example against it, by find_package and by pkg-config, and runs the program: cmake -D BUILD=... -D GENERATOR=... -D CXX=... -D BUILD_TYPE=... -P run.cmake
set(place ${BUILD}/embed)
file(REMOVE_RECURSE ${place})
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${place}/prefix --component dev)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${place}/build -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX}
  -D CMAKE_BUILD_TYPE=${BUILD_TYPE} -D CMAKE_PREFIX_PATH=${place}/prefix)
run(${CMAKE_COMMAND} --build ${place}/build)

# The folder of the .pc file is lib/pkgconfig or lib/ARCHITECTURE/pkgconfig.
file(GLOB_RECURSE pc ${place}/prefix/oort.pc)
cmake_path(GET pc PARENT_PATH pc)
execute_process(COMMAND ${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${pc} pkg-config --cflags --libs "oort >= 0.1"
  COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE)
separate_arguments(flags UNIX_COMMAND ${flags})
run(${CXX} -std=c++17 ${CMAKE_CURRENT_LIST_DIR}/main.cpp -o ${place}/by_pkg_config ${flags})
set(examples ${CMAKE_CURRENT_LIST_DIR}/../../examples/cpp)
run(${CXX} -std=c++17 ${examples}/01_map_a_log.cpp -o ${place}/map_a_log ${flags})

foreach(program build/embed by_pkg_config)
  execute_process(COMMAND ${place}/${program} ${place}/map COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE printed)
  message("${printed}")
  if(NOT printed MATCHES "^[1-9][0-9]* nodes, [1-9][0-9]* x [1-9][0-9]* cells, 1 location\n$")
    message(FATAL_ERROR "the program printed something else than what it should")
  endif()
endforeach()
