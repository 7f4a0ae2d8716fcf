# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Who may look, and who may call: a browser carries requests of pages of others too."""

import hmac
import ipaddress
import secrets
import socket
from dataclasses import dataclass
from urllib.parse import urlsplit

_LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "::1"})


@dataclass(frozen=True)
class Access:
    """The rules of one server."""

    token: str
    """what a visitor must know; empty: nothing, as only this machine can reach the address"""
    hosts: frozenset[str]
    """names under which the server may be asked for, besides addresses in numbers where there is a token"""

    def admits_host(self, host: str) -> bool:
        """Whether a request's Host is this server. A name that another's DNS makes lead here is not (rebinding)."""
        name = _name(host)
        return name in self.hosts or (bool(self.token) and _is_address(name))

    def admits_origin(self, origin: str | None, host: str) -> bool:
        """Whether a request that does something comes from this server's own page: browsers say from where."""
        try:
            return origin is not None and urlsplit(origin).netloc.lower() == host.lower()
        except ValueError:  # no address at all
            return False

    def admits_token(self, token: str) -> bool:
        """Whether a visitor knows the token."""
        return not self.token or hmac.compare_digest(token.encode(), self.token.encode())


def access_for(address: str, token: str) -> Access:
    """The rules for a server at an address. One that others can reach gets a token, made up unless given."""
    if is_loopback(address):
        return Access(token, _LOOPBACK_NAMES)
    names = {address, socket.gethostname(), f"{socket.gethostname()}.local"}
    return Access(token or secrets.token_urlsafe(18), _LOOPBACK_NAMES | {name.lower() for name in names})


def is_loopback(address: str) -> bool:
    """Whether only this machine can reach an address."""
    return address == "localhost" or (_is_address(address) and ipaddress.ip_address(address).is_loopback)


def _name(host: str) -> str:
    """Of a Host header, without the port."""
    try:
        return (urlsplit(f"//{host}").hostname or "").lower()
    except ValueError:
        return ""


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
