"""Skeletons: MVN's."""

import numpy as np
import pytest

import posewire


def test_mvn_has_up_to_four_props_and_forty_fingers():
    assert len(posewire.Skeleton.standard()) == 23
    assert len(posewire.Skeleton.standard(4, fingers=True)) == 67
    assert len(posewire.Skeleton.standard(props=np.int64(2))) == 25


@pytest.mark.parametrize("props", [-1, 5, 200, 2**40, -(2**63), 2**64, 10**500])
def test_other_numbers_of_props_are_wrong_arguments(props):
    with pytest.raises(posewire.UsageError, match="expected a whole number from 0 to 4 as props, found "):
        posewire.Skeleton.standard(props=props)


@pytest.mark.parametrize("props", [1.0, "1", None])
def test_what_is_no_whole_number_is_a_type_error(props):
    with pytest.raises(TypeError, match="as an integer"):
        posewire.Skeleton.standard(props=props)
