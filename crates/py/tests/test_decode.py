"""Datagrams as dicts: the vectors that the Rust crates are tested with."""

import inspect
import json
import random

import numpy as np
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


def read(name):
    return (ROOT / "testdata" / name).read_bytes()


def test_meta_data_are_values_under_their_names():
    meta = posewire.decode(read("mxtp/12_meta_rev_n.bin"))["meta"]
    assert meta == {
        "length": 65,
        "color": "3366cc",
        "count": "2",
        "name": "Zoë",
        "timeOffset": "-3600000",
        "xmid": "00B40A11",
    }


def test_lists_are_lists_whatever_they_hold():
    frame = posewire.decode(read("natnet/frame_4_1.bin"))
    assert frame["message_name"] == "FRAMEOFDATA" and frame["rigid_bodies_count"] == len(frame["rigid_bodies"]) == 2
    assert [device["channels"] for device in frame["devices"]] == [[[0.5]], []]
    assert frame["force_plates"] == [{"id": 7, "channels_count": 2, "channels": [[0.5, 1.5], []]}]
    later = posewire.decode(read("natnet/quirk_extra_sections.bin"), version="4.4")
    assert later["imu"] == {"count": 1, "size": 9, "bytes": b"imu bytes".hex()}


def names(thing):
    for key, value in thing.items() if isinstance(thing, dict) else enumerate(thing):
        yield str(key)
        if isinstance(value, (dict, list)):
            yield from names(value)


@pytest.mark.parametrize("path", VECTORS, ids=lambda path: path.stem)
def test_no_path_is_left_in_a_name(path):
    version = str(json.loads(path.with_suffix(".json").read_text()).get("version", "4.1"))
    protocol = path.parent.name
    decoded = posewire.decode(path.read_bytes(), protocol, version if protocol == "natnet" else None)
    assert json.dumps(decoded)
    assert not [name for name in names(decoded) if set(name) & set(".[]")]


@pytest.mark.parametrize("kind", [bytearray, memoryview, lambda data: np.frombuffer(data, np.uint8)])
def test_anything_that_has_bytes_is_decoded(kind):
    datagram = read("mxtp/02_quaternion_rev_n.bin")
    assert posewire.decode(kind(datagram)) == posewire.decode(datagram)
    spread = bytes(byte for byte in datagram for _ in range(2))
    assert posewire.decode(kind(spread)[::2]) == posewire.decode(datagram)


@pytest.mark.parametrize("data", ["MXTP02", None, 5, [77, 88], np.zeros(4)])
def test_what_has_no_bytes_is_a_type_error(data):
    with pytest.raises(TypeError):
        posewire.decode(data)


def test_what_stands_after_the_end_is_told():
    decoded = posewire.decode(read("mxtp/02_quaternion_rev_n.bin") + b"more")
    assert bytes.fromhex(decoded["trailing"]) == b"more" and "trailing-bytes" in decoded["quirks"]


def test_damaged_datagrams_are_decoded_or_refused():
    damage = random.Random(5)
    for path in VECTORS:
        for _ in range(20):
            data = bytearray(path.read_bytes())
            for _ in range(damage.randint(1, 4)):
                data[damage.randrange(len(data))] = damage.randrange(256)
            data = data[: damage.randint(0, len(data))] if damage.random() < 0.3 else data
            for version in (None,) if data[:4] == b"MXTP" else ("2.9", "4.1", "4.5"):
                try:
                    assert isinstance(posewire.decode(data, version=version)["quirks"], list)
                except posewire.DecodeError:
                    pass


def test_the_documentation_shows_the_shape():
    assert '"protocol": "mxtp"' in inspect.getdoc(posewire.decode)


def test_what_is_neither_protocol_is_refused():
    for data in (b"", b"no", b"hello world, this is no datagram"):
        with pytest.raises(posewire.DecodeError, match='begins with "MXTP", or one of NatNet, found'):
            posewire.decode(data)
    with pytest.raises(posewire.DecodeError, match='it begins with "MXTP"'):
        posewire.decode(read("mxtp/02_quaternion_rev_n.bin"), protocol="natnet")


def test_a_frame_of_another_version_is_said_to_be_one():
    with pytest.raises(posewire.DecodeError) as refused:
        posewire.decode(read("natnet/frame_4_1.bin"), version="3.0")
    assert "this is not one of 3.0" in refused.value.help
    with pytest.raises(posewire.DecodeError) as refused:
        posewire.decode(read("natnet/model_4_1.bin")[:-9])
    assert "these are not of 4.1" in refused.value.help


@pytest.mark.parametrize("version", ["9.9", "1.3", "4.6", "4", "4.1.0", "new", ""])
def test_a_version_that_there_is_not_is_refused(version):
    with pytest.raises(posewire.UsageError, match="expected a version of NatNet from 1.4 to 4.5, found"):
        posewire.decode(read("natnet/frame_4_1.bin"), version=version)


def test_a_version_of_mxtp_is_refused():
    with pytest.raises(posewire.UsageError, match="version= is of NatNet"):
        posewire.decode(read("mxtp/02_quaternion_rev_n.bin"), version="4.1")


def test_what_is_no_datagram_is_refused():
    with pytest.raises(posewire.DecodeError, match="no datagram of MXTP"):
        posewire.decode(b"MXTP02 and nothing else")
    with pytest.raises(posewire.DecodeError, match="no datagram of NatNet"):
        posewire.decode(b"\x07", protocol="natnet")
    with pytest.raises(posewire.UsageError):
        posewire.decode(b"", protocol="osc")
