# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The documentation as a site: it builds, every page is in its menu, and no link or anchor in it is dead."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from playwright.sync_api import Browser
from ruamel.yaml import YAML

from conftest import ROOT


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("pages")
    subprocess.run([sys.executable, str(ROOT / "scripts/gather_pages.py"), str(folder)], check=True)
    return folder


def _build(pages: Path, out: Path) -> subprocess.CompletedProcess[str]:
    settings = YAML(typ="safe").load((ROOT / "mkdocs.yml").read_text())
    file = out / "mkdocs.yml"
    with file.open("w") as stream:
        YAML(typ="safe").dump(settings | {"docs_dir": str(pages), "site_dir": str(out / "site")}, stream)
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "-f", str(file)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_the_site_builds_without_a_dead_link(pages: Path, tmp_path: Path) -> None:
    done = _build(pages, tmp_path)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "site/docs/loops.html").is_file()
    assert (tmp_path / "site/docs/images/home.png").is_file()
    assert ">Accuracy</a>" in (tmp_path / "site/docs/tuning.html").read_text()
    assert not re.search(r">[\w/]+\.md</a>", (tmp_path / "site/docs/tuning.html").read_text())


def test_search_works_from_disk(pages: Path, tmp_path: Path, browser: Browser) -> None:
    assert _build(pages, tmp_path).returncode == 0
    errors: list[str] = []
    context = browser.new_context(offline=True)
    page = context.new_page()
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("request", lambda request: errors.append(request.url) if request.url.startswith("http") else None)
    page.goto((tmp_path / "site/docs/loops.html").as_uri())
    page.locator("input.md-search__input").click()
    page.keyboard.type("loop closure")
    page.locator(".md-search-result__item a").first.click()
    page.wait_for_url("**/*.html?h=*")
    context.close()
    assert errors == []


def test_a_dead_link_would_be_found(pages: Path, tmp_path: Path) -> None:
    for number, link in enumerate(["none.md", "loops.md#no-such-part"]):
        page = pages / f"docs/added{number}.md"
        page.write_text(f"# Added\n\n[it]({link})\n")
        done = _build(pages, tmp_path)
        page.unlink()
        assert done.returncode != 0
        assert f"added{number}.md" in done.stderr


def test_every_page_is_in_the_menu(pages: Path) -> None:
    menu = (ROOT / "mkdocs.yml").read_text()
    for page in pages.rglob("*.md"):
        assert f": {page.relative_to(pages)}\n" in menu, page
