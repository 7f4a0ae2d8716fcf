# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Who may look at a live session, and who may call."""

import socket

import pytest

from oort.view.access import access_for, is_loopback


@pytest.mark.parametrize("host", ["localhost:8765", "127.0.0.1:8765", "[::1]:9000", "LOCALHOST"])
def test_this_machine_by_its_names(host: str) -> None:
    assert access_for("127.0.0.1", "").admits_host(host)


@pytest.mark.parametrize(
    "host", ["evil.example", "localhost.evil.example:8765", "127.0.0.1.evil.example", "", "192.168.1.7:8765", "[::1"]
)
def test_a_name_that_somebody_made_lead_here(host: str) -> None:
    assert not access_for("127.0.0.1", "").admits_host(host)


def test_an_address_for_others_has_a_token_and_goes_by_numbers_and_the_machines_name() -> None:
    access = access_for("0.0.0.0", "")
    assert len(access.token) >= 20
    assert access.token != access_for("0.0.0.0", "").token
    for host in ("192.168.1.7:8765", f"{socket.gethostname()}:8765"):
        assert access.admits_host(host)
    assert not access.admits_host("evil.example")
    assert access.admits_token(access.token)
    for wrong in ("", "x", access.token[:-1], "é"):
        assert not access.admits_token(wrong)


def test_a_token_may_be_given_and_counts_on_loopback_too() -> None:
    assert access_for("127.0.0.1", "").admits_token("")
    assert not access_for("127.0.0.1", "secret").admits_token("")
    assert access_for("0.0.0.0", "secret").token == "secret"


@pytest.mark.parametrize(
    ("origin", "admitted"),
    [
        ("http://localhost:8765", True),
        ("http://LOCALHOST:8765", True),
        ("http://localhost:9999", False),
        ("http://evil.example", False),
        ("null", False),
        ("http://[", False),
        (None, False),
    ],
)
def test_calls_come_from_the_page_itself(origin: str | None, admitted: bool) -> None:
    assert access_for("127.0.0.1", "").admits_origin(origin, "localhost:8765") == admitted


def test_what_only_this_machine_reaches() -> None:
    assert all(map(is_loopback, ("localhost", "127.0.0.1", "127.8.0.1", "::1")))
    assert not any(map(is_loopback, ("0.0.0.0", "::", "192.168.1.7", "robot.local", "")))
