# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The ROS 1 node: topics, transforms and services over the live session; only here is rospy imported."""
