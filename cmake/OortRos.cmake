# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Generates the Python module oort_msgs with Debian's genpy and lays out the ROS packages oort and oort_msgs.
# Programs lie in share/oort, not in lib/oort: there rosrun needs nothing but ROS_PACKAGE_PATH.
include(${CMAKE_CURRENT_LIST_DIR}/OortLaunchers.cmake)
set(ros_dir ${CMAKE_CURRENT_SOURCE_DIR}/ros)
set(ros_python /usr/bin/python3)  # the one that genpy is installed for
set(genpy_dir /usr/lib/genpy)
set(needed ${genpy_dir}/gensrv_py.py ${genpy_dir}/genmsg_py.py)
set(include_options)
foreach(package std_msgs geometry_msgs nav_msgs)
  list(APPEND needed /usr/share/${package}/msg)
  list(APPEND include_options -I${package}:/usr/share/${package}/msg)
endforeach()
foreach(path ${needed})
  if(NOT EXISTS ${path})
    message(STATUS "Oort is built without its ROS node: there is no ${path}. scripts/setup.sh --ros installs it.")
    return()
  endif()
endforeach()

# ---- the Python classes of the services; one process for all of them, for its start is nearly all its time ----
set(module_dir ${CMAKE_CURRENT_BINARY_DIR}/oort_msgs)
set(generate ${CMAKE_COMMAND} -E env --unset=PYTHONPATH ${ros_python})
file(GLOB services CONFIGURE_DEPENDS ${ros_dir}/oort_msgs/srv/*.srv)
set(classes ${module_dir}/srv/__init__.py)
foreach(service ${services})
  get_filename_component(name ${service} NAME_WE)
  list(APPEND classes ${module_dir}/srv/_${name}.py)
endforeach()
add_custom_command(OUTPUT ${classes}
  COMMAND ${generate} ${genpy_dir}/gensrv_py.py ${services} ${include_options} -p oort_msgs -o ${module_dir}/srv
  COMMAND ${generate} ${genpy_dir}/genmsg_py.py --initpy -o ${module_dir}/srv
  DEPENDS ${services} VERBATIM COMMENT "Generating the Python module oort_msgs")
file(WRITE ${module_dir}/__init__.py "")
add_custom_target(oort_msgs ALL DEPENDS ${classes})

# ---- the install space ----
set(prefix "")
if(SKBUILD)
  set(prefix ${SKBUILD_DATA_DIR}/)
  install(DIRECTORY ${module_dir} DESTINATION ${SKBUILD_PLATLIB_DIR} COMPONENT ros FILES_MATCHING PATTERN "*.py")
endif()
# Once more, alone in a directory: the ROS tools must not see what else site-packages holds.
install(DIRECTORY ${module_dir} DESTINATION ${prefix}lib/oort/python COMPONENT ros FILES_MATCHING PATTERN "*.py")
install(DIRECTORY ${ros_dir}/oort_msgs/srv DESTINATION ${prefix}share/oort_msgs COMPONENT ros)
install(FILES ${ros_dir}/oort_msgs/package.xml DESTINATION ${prefix}share/oort_msgs COMPONENT ros)
install(FILES cmake/oort_msgs_manifest.xml DESTINATION ${prefix}share/oort_msgs RENAME manifest.xml COMPONENT ros)
install(DIRECTORY ${ros_dir}/oort/launch ${ros_dir}/oort/rviz DESTINATION ${prefix}share/oort COMPONENT ros)
install(FILES ${ros_dir}/oort/package.xml ${ros_dir}/oort/setup.bash DESTINATION ${prefix}share/oort COMPONENT ros)
oort_launchers(${ros_dir}/oort/launcher.in "$here/../../bin/python3" programs)
install(PROGRAMS ${programs} DESTINATION ${prefix}share/oort COMPONENT ros)
