# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The documentation is true: its Python examples run, and it names every option, call and file there is."""

import re
import subprocess
import sys
from pathlib import Path
from urllib.parse import urlsplit

import pytest

from conftest import ROOT
from oort import Parameters, Session, StateError
from oort.cli.main import main
from oort.simulate import SimulationConfig, simulate_drive
from oort.simulate.writers import write_drive

USAGE = (ROOT / "docs/usage.md").read_text(encoding="utf-8")
PAGES = [
    "README.md",
    "CONTRIBUTING.md",
    *(str(page.relative_to(ROOT)) for page in sorted((ROOT / "docs").glob("*.md"))),
]


def _examples(page: str) -> list[str]:
    return re.findall(r"^```python\n(.*?)^```", (ROOT / page).read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)


@pytest.mark.parametrize("page", ["README.md", "docs/usage.md"])
def test_examples_run(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_drive(simulate_drive(1, SimulationConfig(minutes=0.0)), tmp_path, "drive", picture=False)
    monkeypatch.chdir(tmp_path)
    examples = _examples(page)
    assert examples
    for example in examples:
        exec(compile(example, page, "exec"), {})
    assert (tmp_path / "my_map.map_capnp").is_file()


@pytest.mark.parametrize(
    "tool",
    [
        "replay",
        "check",
        "localize",
        "simulate",
        "evaluate ate",
        "evaluate relations",
        "evaluate autogenerate",
        "graph solve",
        "prune",
        "history",
        "migrate",
        "merge",
        "batch",
        "tune",
        "compare",
        "view",
        "info",
        "completion",
        "rooms",
        "areas",
        "export",
        "parameters table",
    ],
)
def test_every_option_is_explained(tool: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main([*tool.split(), "--help"])
    for option in re.findall(r"--[a-z-]+", capsys.readouterr().out):
        assert option == "--help" or f"`{option}" in USAGE, option


def test_every_call_is_explained() -> None:
    with pytest.raises(StateError) as caught:
        Session(Parameters()).call("?")
    for call in str(caught.value).partition("the calls are: ")[2].split(", "):
        assert f"| `{call}` |" in USAGE, call


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page: str) -> None:
    path = ROOT / page
    for target in re.findall(r"\]\(([^)#]+)[^)]*\)", path.read_text(encoding="utf-8")):
        assert target.startswith("https://") or (path.parent / target).exists(), target


def test_links_to_elsewhere_can_be_links() -> None:
    listing = subprocess.run(
        [sys.executable, str(ROOT / "scripts/external_links.py")], capture_output=True, text=True, check=True
    )
    links = [line.partition("\t")[0] for line in listing.stdout.splitlines()]
    assert len(links) > 30
    for link in links:
        parts = urlsplit(link)
        assert parts.scheme in ("https", "http"), link
        assert re.fullmatch(r"[a-z0-9-]+(\.[a-z0-9-]+)+", parts.netloc), link
        assert re.fullmatch(r"[!-~]+", link), link
