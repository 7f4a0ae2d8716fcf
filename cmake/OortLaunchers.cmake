# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# oort_launchers(TEMPLATE PYTHON RESULT): writes the programs that rosrun starts into the build directory and sets
# RESULT to their paths. PYTHON is the interpreter that they run, as the shell is to read it.
function(oort_launchers template python result)
  set(paths)
  foreach(entry oort_ros=oort.node oort_localizer=oort.node.localizer oort_bag=oort.cli.oort_bag oort_conv=oort.render)
    string(REGEX MATCH "^(.*)=(.*)$" entry ${entry})
    set(program ${CMAKE_MATCH_1})
    set(module ${CMAKE_MATCH_2})
    set(path ${CMAKE_CURRENT_BINARY_DIR}/launchers/${program})
    configure_file(${template} ${path} @ONLY NEWLINE_STYLE UNIX
      FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
    list(APPEND paths ${path})
  endforeach()
  set(${result} ${paths} PARENT_SCOPE)
endfunction()
