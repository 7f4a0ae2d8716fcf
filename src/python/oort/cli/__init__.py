# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The command line: the command ``oort`` and a module for each of its tools. Only here are arguments parsed."""
