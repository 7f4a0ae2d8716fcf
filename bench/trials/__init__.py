# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The parts of bench/accuracy.py: drives, their replay, what is compared with the truth, and the rows of the table."""
