# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What tests of several rooms share: scans, recordings, a live session that is listened to, the golden maps."""
