# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Reading params.json, and writing the shipped files from the one table that declares the parameters.

The table is the engine's (src/cpp/oort/parameters). ``python -m oort.parameters`` prints it and writes the files.
"""

from oort._core import ParameterEntry, Parameters, parameter_table
from oort.parameters.reader import packaged_parameters, packaged_path, read_parameters

__all__ = [
    "ParameterEntry",
    "Parameters",
    "packaged_parameters",
    "packaged_path",
    "parameter_table",
    "read_parameters",
]
