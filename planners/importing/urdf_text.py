"""The XML of a URDF: checked, and reduced to links, collision geometry and joints."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ellipsoid_planning import input_files
from ellipsoid_planning.errors import UrdfError
from planners.importing.libraries import library
from planners.importing.urdf_numbers import check_numbers

SHAPES = ("box", "capsule", "cylinder", "mesh", "sphere")
# What a joint's plans do not heed.
LIMITS_DROPPED = ("velocity", "effort")
PARTS_DROPPED = ("dynamics", "safety_controller")
# What expands to other text, perhaps without end, or reads other files.
ENTITY = b"<!ENTITY"
JOINT_PARTS = ("origin", "axis", "limit", "mimic")


@dataclass(frozen=True, eq=False)
class Description:
    """What a URDF says of a robot's shape and motion.

    Attributes:
        file: the URDF.
        robot: yourdfpy's ``Robot`` with its links, their collision geometry, and its joints.
        capsules: which (link, index of the collision) are capsules; the robot says cylinders.
        dropped: of each joint, what is said of it that plans of geometry have no use for.
    """

    file: Path
    robot: Any
    capsules: frozenset[tuple[str, int]]
    dropped: Mapping[str, tuple[str, ...]]


def read_description(file: Path) -> Description:
    """Read a URDF.

    Undeclared namespace prefixes, as of ``drake:acceleration``, are common in URDFs and are left
    out; all other mistakes in the XML are refused. The library knows no capsules, so that it is
    told of cylinders in their place.

    Raises:
        UrdfError: the file cannot be read, or is no URDF.
    """
    root = _parsed(file)
    if root.tag != "robot":
        raise UrdfError(f"{file}: expected a URDF, whose first element is <robot>, got {root.tag}")
    for element in root.iter():
        if "xacro" in str(element.tag):
            raise UrdfError(f"{file}:{element.sourceline}: this is a xacro; run xacro on it first")
    etree = library("lxml.etree")
    reduced = etree.Element("robot", name=root.get("name", file.stem))
    capsules: set[tuple[str, int]] = set()
    for link in root.findall("link"):
        reduced.append(_reduced_link(file, link, capsules))
    dropped = {}
    for joint in root.findall("joint"):
        reduced.append(_reduced_joint(file, joint))
        dropped[str(joint.get("name"))] = _dropped(joint)
    return Description(file, _robot(file, etree.tostring(reduced)), frozenset(capsules), dropped)


def _dropped(joint: Any) -> tuple[str, ...]:
    limit = joint.find("limit")
    given = [] if limit is None else [name for name in LIMITS_DROPPED if limit.get(name)]
    return (*given, *(part for part in PARTS_DROPPED if joint.find(part) is not None))


def _parsed(file: Path) -> Any:
    etree = library("lxml.etree")
    # Recovering reads on after the first mistake, so that harmless ones can be let pass.
    parser = etree.XMLParser(
        recover=True, resolve_entities=False, no_network=True, remove_comments=True
    )
    try:
        text = input_files.read_bytes(file)
        if ENTITY in text:
            raise UrdfError(
                f"{file}: expected a URDF without entities, got {ENTITY.decode()}; "
                "write out what they stand for"
            )
        root = etree.fromstring(text, parser)
    except OSError as error:
        raise UrdfError(f"{file}: cannot read the file: {error.strerror}") from None
    except etree.XMLSyntaxError as error:
        raise UrdfError(f"{file}: no XML: {error.msg}") from None
    for entry in parser.error_log:
        if entry.domain_name != "NAMESPACE":
            raise UrdfError(f"{file}:{entry.line}:{entry.column}: broken XML: {entry.message}")
    if root is None:
        raise UrdfError(f"{file}: no XML: the file has no element")
    internal = root.getroottree().docinfo.internalDTD
    if internal is not None and any(internal.iterentities()):
        raise UrdfError(f"{file}: expected a URDF without entities; write out what they stand for")
    return root


def _reduced_link(file: Path, link: Any, capsules: set[tuple[str, int]]) -> Any:
    etree = library("lxml.etree")
    name = _required(file, link, "name")
    reduced = etree.Element("link", name=name)
    for index, collision in enumerate(link.findall("collision")):
        shape = _shape(file, name, collision)
        check_numbers(file, f"link {name!r}", shape, _local(shape))
        if _local(shape) == "capsule":
            capsules.add((name, index))
        kept = etree.SubElement(reduced, "collision")
        kind = "cylinder" if _local(shape) == "capsule" else _local(shape)
        etree.SubElement(etree.SubElement(kept, "geometry"), kind, _plain(shape))
        if collision.find("origin") is not None:
            check_numbers(file, f"link {name!r}", collision.find("origin"), "origin")
            etree.SubElement(kept, "origin", _plain(collision.find("origin")))
    return reduced


def _shape(file: Path, link: str, collision: Any) -> Any:
    geometry = collision.find("geometry")
    shapes = [] if geometry is None else [child for child in geometry if isinstance(child.tag, str)]
    kinds = ", ".join(SHAPES)
    if not shapes:
        raise UrdfError(
            f"{file}:{collision.sourceline}: link {link!r}: a <collision> without geometry; "
            f"expected one of {kinds}"
        )
    if _local(shapes[0]) not in SHAPES:
        raise UrdfError(
            f"{file}:{shapes[0].sourceline}: link {link!r}: expected the geometry to be one of "
            f"{kinds}, got {shapes[0].tag}"
        )
    return shapes[0]


def _reduced_joint(file: Path, joint: Any) -> Any:
    etree = library("lxml.etree")
    name = _required(file, joint, "name")
    reduced = etree.Element("joint", name=name, type=_required(file, joint, "type"))
    for role in ("parent", "child"):
        element = joint.find(role)
        if element is None:
            raise UrdfError(f"{file}:{joint.sourceline}: joint {name!r}: <{role}> is missing")
        etree.SubElement(reduced, role, link=_required(file, element, "link"))
    for part in JOINT_PARTS:
        if joint.find(part) is not None:
            check_numbers(file, f"joint {name!r}", joint.find(part), part)
            etree.SubElement(reduced, part, _plain(joint.find(part)))
    return reduced


def _required(file: Path, element: Any, attribute: str) -> str:
    value = element.get(attribute)
    if not value:
        of = element.get("name") or element.getparent().get("name")
        place = f"{file}:{element.sourceline}: <{element.tag}>" + (f" of {of!r}" if of else "")
        raise UrdfError(f"{place}: the attribute {attribute!r} is missing")
    return str(value)


def _local(element: Any) -> str:
    """The tag without namespace or prefix."""
    return str(element.tag).rpartition("}")[2].rpartition(":")[2]


def _plain(element: Any) -> dict[str, str]:
    """The attributes that are URDF's own."""
    return {key: value for key, value in element.attrib.items() if not {":", "}"} & set(key)}


def _robot(file: Path, text: bytes) -> Any:
    yourdfpy = library("yourdfpy")
    try:
        return yourdfpy.URDF.load(
            io.BytesIO(text), build_scene_graph=False, load_meshes=False
        ).robot
    except (ValueError, TypeError, AttributeError) as error:
        raise UrdfError(f"{file}: a number is wrong: {error}") from None
    except KeyError as error:
        raise UrdfError(f"{file}: the attribute {error} is missing") from None
