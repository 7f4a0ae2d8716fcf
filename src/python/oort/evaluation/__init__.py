# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How good trajectories, maps and pose graphs are, and what became of closures."""
