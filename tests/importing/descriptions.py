"""URDFs for tests: those of an installed package, and small ones with meshes written here."""

import importlib.util
from pathlib import Path

import numpy as np

BUNDLE = Path(importlib.util.find_spec("airo_models").submodule_search_locations[0])
ARM = BUNDLE / "arms" / "ur5e" / "ur5e.urdf"
GRIPPER = BUNDLE / "grippers" / "robotiq_2f_85" / "urdf" / "robotiq_2f_85.urdf"

TWO_LINKS = """\
<?xml version="1.0"?>
<robot name="two">
  <link name="base"><collision><geometry><box size="1 2 3"/></geometry></collision></link>
  <link name="arm">
    <collision>
      <origin xyz="0 0 1"/><geometry><cylinder radius="0.2" length="2"/></geometry>
    </collision>
  </link>
  <joint name="turn" type="revolute">
    <parent link="base"/><child link="arm"/>
    <origin xyz="0 0 2" rpy="0.1 0.2 0.3"/><axis xyz="0 2 0"/>
    <limit lower="-1" upper="2" effort="1" velocity="1"/>
  </joint>
</robot>
"""


def written(folder, *replacements, name="two.urdf"):
    """The small URDF with texts replaced, as a file."""
    text = TWO_LINKS
    for old, new in replacements:
        assert old in text
        text = text.replace(old, new)
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return file


def mesh_text(vertices, faces):
    """A mesh as the text of an OBJ file."""
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in np.asarray(vertices, dtype=float).tolist()]
    lines += ["f " + " ".join(str(index + 1) for index in face) for face in faces]
    return "\n".join(lines) + "\n"


# A corner of two bars: not convex.
BEND_OUTLINE = np.array([[0, 0], [4, 0], [4, 1], [1, 1], [1, 4], [0, 4]], dtype=float)
BEND_VERTICES = np.concatenate([np.column_stack([BEND_OUTLINE, np.full(6, z)]) for z in (0.0, 1.0)])
BEND_FACES = [
    *[(i, (i + 1) % 6, 6 + (i + 1) % 6) for i in range(6)],
    *[(i, 6 + (i + 1) % 6, 6 + i) for i in range(6)],
    *[(0, b, a) for a, b in ((1, 2), (2, 3), (3, 4), (4, 5))],
    *[(6, 6 + a, 6 + b) for a, b in ((1, 2), (2, 3), (3, 4), (4, 5))],
]
