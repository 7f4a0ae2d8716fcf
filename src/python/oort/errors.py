# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The exceptions that Oort raises: one family, thrown by the engine and by the Python modules alike."""

from oort._core import Error as OortError
from oort._core import InputError, MapFileError, ParameterError, StateError

__all__ = ["InputError", "MapFileError", "OortError", "ParameterError", "StateError"]
