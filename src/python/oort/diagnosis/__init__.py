# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What is wrong with a recording or a robot's setup, from what its scans and its mapping show."""

from oort.diagnosis.drive import diagnose
from oort.diagnosis.loose import loose_parts
from oort.diagnosis.observer import Observer
from oort.diagnosis.trouble import Trouble

__all__ = ["Observer", "Trouble", "diagnose", "loose_parts"]
