"""Operations: triplets read and printed, composed and undone, all exactly."""

from fractions import Fraction

import pytest

from ellipsoid_planning.crystal import Operation
from ellipsoid_planning.errors import CrystalError

TRIPLETS = {
    # What is written on the right is the shortest form of the left.
    "x,y,z": "x,y,z",
    " ( X , Y , Z ) ": "x,y,z",
    "-2x+1/4+y+z,-x+y+z+5/4,-x+y-z+1/4": "-2x+y+z+1/4,-x+y+z+5/4,-x+y-z+1/4",  # thesis, A.1
    "1/2-x,-y,.5+z": "-x+1/2,-y,z+1/2",
    "(-(x-y)+1/2, y/2, 2*z)": "-x+y+1/2,1/2*y,2z",
    "2(x+y)/4,y,z": "1/2*x+1/2*y,y,z",
    "\N{MINUS SIGN}x,y+0.25,z": "-x,y+1/4,z",
    "(-y,x-y)": "-y,x-y",
    "(x-y),y": "x-y,y",
    "3x-2x,y": "x,y",
}


def test_triplets_are_read_and_printed():
    for text, printed in TRIPLETS.items():
        operation = Operation.parse(text)
        assert operation.triplet() == str(operation) == printed
        assert Operation.parse(printed) == operation


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "expected three coordinates"),
        ("x", "got 1"),
        ("x,y,z,x", "got 4"),
        ("x,y,q", "unexpected 'q'"),
        ("x,z", "unexpected 'z'"),
        ("x+,y,z", "ends too early"),
        ("x,,z", "ends too early"),
        ("(x,y", "not closed"),
        ("x),y,z", "unexpected ')'"),
        ("xy,y,z", "not linear"),
        ("2 3x,y,z", "unexpected '3'"),
        ("x/0,y,z", "other than zero"),
        ("x/y,y,z", "other than zero"),
        ("1..5+x,y,z", "unexpected '.5'"),
        ("x,x,z", "invertible"),
        ("1,y,z", "invertible"),
        ("x" * 5000 + ",y,z", "5004 letters"),
    ],
)
def test_bad_triplets_get_one_clear_message(text, words):
    with pytest.raises(CrystalError) as caught:
        Operation.parse(text)
    assert words in str(caught.value)
    assert len(str(caught.value)) < 250


def test_composition_takes_the_right_one_first():
    screw, glide = Operation.parse("-x,y+1/2,-z"), Operation.parse("x,-y+1/4,z+1/2")
    product = screw @ glide
    assert product == screw.compose(glide) == Operation.parse("-x,-y+3/4,-z-1/2")
    assert glide @ screw == Operation.parse("-x,-y-1/4,-z+1/2")
    assert product.modulo() == Operation.parse("-x,-y+3/4,-z+1/2")
    assert product.rotation == ((-1, 0, 0), (0, -1, 0), (0, 0, -1))
    assert product.translation == (0, Fraction(3, 4), Fraction(-1, 2))


def test_inverses_of_unimodular_and_other_operations():
    for text in ("-y+1/3,x-y,z+2/3", "-2x+1/4+y+z,-x+y+z+5/4,-x+y-z+1/4", "2x+y,x-3y+1/7"):
        operation = Operation.parse(text)
        identity = Operation.identity(operation.dimension)
        assert operation @ operation.inverse() == operation.inverse() @ operation == identity
        assert operation.inverse().determinant == 1 / Fraction(operation.determinant)


def test_modulo_a_centred_lattice():
    half = Fraction(1, 2)
    lattice = ((half, half, 0), (-half, half, 0), (0, 0, 1))  # of a C-centred cell
    first, second = Operation.parse("-x+3/4,y+1/4,z-5/4"), Operation.parse("-x+1/4,y+3/4,z-1/4")
    assert first.modulo() != second.modulo()
    assert first.modulo(lattice) == second.modulo(lattice)
    shift = Operation.shift([half, half, 0])
    assert (shift @ first).modulo(lattice) == first.modulo(lattice)


def test_shapes_are_checked():
    with pytest.raises(CrystalError, match="matrix"):
        Operation(((1, 0), (0, 1)), (0, 0, 0))
