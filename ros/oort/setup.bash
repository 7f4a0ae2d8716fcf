# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# To be sourced: source PREFIX/share/oort/setup.bash. After that rosrun, roslaunch, rosservice and rossrv know Oort.
_oort_prefix=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
if [ -f "$_oort_prefix/bin/activate" ] && [ "${VIRTUAL_ENV:-}" != "$_oort_prefix" ]; then
  source "$_oort_prefix/bin/activate"
fi
case ":${ROS_PACKAGE_PATH:-}:" in
  *":$_oort_prefix/share:"*) ;;
  *) export ROS_PACKAGE_PATH="$_oort_prefix/share${ROS_PACKAGE_PATH:+:$ROS_PACKAGE_PATH}" ;;
esac
unset _oort_prefix
