# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Work on what was recorded or saved before: replays, following on a map, merging, migrating, drawing."""
