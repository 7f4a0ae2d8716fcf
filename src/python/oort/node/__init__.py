# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The ROS nodes: topics, transforms and services over the live session and the localiser.

Their messages are those of the ROS that is there; all else that differs between ROS 1 and ROS 2 lies in `middleware`.
"""
