"""Datagrams as dicts: the vectors that the Rust crates are tested with."""

import json

import pytest
from conftest import ROOT

import posewire

VECTORS = sorted((ROOT / "testdata").glob("*/*.bin"))


def test_there_are_vectors():
    assert len(VECTORS) > 20


@pytest.mark.parametrize("path", [path for path in VECTORS if path.parent.name == "mxtp"], ids=lambda path: path.stem)
def test_every_mxtp_vector_is_decoded(path):
    decoded = posewire.decode(path.read_bytes())
    assert decoded["protocol"] == "mxtp"
    assert decoded["header"]["magic"].startswith("MXTP")


@pytest.mark.parametrize("path", [path for path in VECTORS if path.parent.name == "natnet"], ids=lambda path: path.stem)
def test_every_natnet_vector_is_decoded(path):
    expected = json.loads(path.with_suffix(".json").read_text())
    version = expected.get("version", "4.1")
    decoded = posewire.decode(path.read_bytes(), protocol="natnet", version=str(version))
    assert decoded["protocol"] == "natnet" and "message" in decoded


def test_fields_stand_where_their_paths_say():
    decoded = posewire.decode((ROOT / "testdata/mxtp/02_quaternion_rev_j.bin").read_bytes())
    assert len(decoded["segments"]) == 23
    assert set(decoded["segments"][0]["position"]) == {"x", "y", "z"}
    assert json.dumps(decoded["segments"][22])


def test_what_is_no_datagram_is_refused():
    with pytest.raises(posewire.DecodeError, match="no datagram of MXTP"):
        posewire.decode(b"MXTP02 and nothing else")
    with pytest.raises(posewire.DecodeError, match="no datagram of NatNet"):
        posewire.decode(b"\x07")
    with pytest.raises(posewire.UsageError):
        posewire.decode(b"", protocol="osc")
