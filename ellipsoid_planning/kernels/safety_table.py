"""Tabulated safety functions (thesis 6.4): is a link safe where forward kinematics puts it?

A *table* holds, for each cell of a grid of orientations and each sweep line of a grid of lines,
intervals of the place of the link's middle in which the link is safe at every orientation and on
every line of the cell. "Safe" is proved; anything else is left to the exact test of that link.

An orientation is looked up by a vector of ``VECTOR`` numbers: none that matters (a link that
does not turn, a ball), the link's heading (2 numbers), the direction of its axis (3), or its
quaternion (4). Its largest component tells the face of a cube around the sphere of such vectors,
the ratios of the others to it tell the cell in that face (see safety.orientation_grid).

The *book* is one flat array: a header, rows of ``LINK`` numbers for the bodies of
kernels.kinematics, rows of ``TABLE`` numbers for the tables, then the parts of each body: (bodies
+ 1) places where they begin, and their numbers. Intervals stand in pairs of 16-bit numbers,
``SWEEP`` to the unit of length from ``LOW``, those of line k of a table from
``offsets[FIRST + k]`` on.
"""

from .articulated_states import is_well_formed, row_of_state
from .compile import inlined, kernel
from .kinematics import body_frames, new_frames, owners_of, place_on_frames, within_limits
from .layout import new_placed, part_rows
from .self_collision import first_self_contact, new_body, new_order
from .validity import in_bounds, is_rotation, part_is_free

# Header
BODIES = 0
TABLES = 1
BOOK_HEADER = 2

# Link rows: the table (−1 for none), the middle and the turn of the table's frame in the body's.
LINK_TABLE = 0
LINK_MIDDLE = 1
LINK_TURN = 4
LINK = 13

# Table rows
VECTOR = 0
FACES = 1
CELLS = 2
AXIS = 3
LOW = 4
HIGH = 7
PER = 10
LINES = 13
SWEEP = 16
FIRST = 17
SAFE_LOW = 18
SAFE_HIGH = 21
TABLE = 24

# The cells of a face have about the same angles: u ↦ u (1 + B − B|u|) is close to 4/π atan u.
BEND = 0.348


@kernel
def link_rows(book):
    """Rows of the bodies, shape (bodies, LINK), as a view."""
    bodies = int(book[BODIES])
    return book[BOOK_HEADER : BOOK_HEADER + bodies * LINK].reshape((bodies, LINK))


@kernel
def table_rows(book):
    """Rows of the tables, shape (tables, TABLE), as a view."""
    first, tables = BOOK_HEADER + int(book[BODIES]) * LINK, int(book[TABLES])
    return book[first : first + tables * TABLE].reshape((tables, TABLE))


@kernel
def members_of(book):
    """Where the parts of each body begin (bodies + 1), then their numbers, as a view."""
    return book[BOOK_HEADER + int(book[BODIES]) * LINK + int(book[TABLES]) * TABLE :]


@inlined
def _step(other, largest, cells):
    """The cell, along one coordinate of a face, of the ratio ``other`` : ``largest``."""
    u = other / largest
    w = u * ((1.0 + BEND) - BEND * abs(u))
    return min(max(int((0.5 * cells) * (w + 1.0)), 0), cells - 1)


@kernel
def heading_cell(x, y, faces, cells):
    """The cell of a vector (2,) of any length; two faces: opposite vectors are the same."""
    if abs(x) >= abs(y):
        face, k = (0 if x > 0.0 or faces == 2 else 2), _step(y, x, cells)
    else:
        face, k = (1 if y > 0.0 or faces == 2 else 3), _step(x, y, cells)
    return face * cells + k


@kernel
def direction_cell(x, y, z, faces, cells):
    """The cell of a vector (3,) of any length; three faces: opposite vectors are the same."""
    if abs(x) >= abs(y) and abs(x) >= abs(z):
        face, top, a, b = 0, x, y, z
    elif abs(y) >= abs(z):
        face, top, a, b = 1, y, z, x
    else:
        face, top, a, b = 2, z, x, y
    if top < 0.0 and faces == 6:
        face += 3
    return (face * cells + _step(a, top, cells)) * cells + _step(b, top, cells)


@kernel
def quaternion_cell(x, y, z, w, faces, cells):
    """The cell of a quaternion of any length; opposite ones are the same.

    One face: those that differ by half-turns about the link's axes are the same too.
    """
    # Multiplying by i, j or k from the right brings any component to the last place.
    if abs(w) >= abs(x) and abs(w) >= abs(y) and abs(w) >= abs(z):
        face, top, a, b, c = 0, w, x, y, z
    elif abs(x) >= abs(y) and abs(x) >= abs(z):
        face, top, a, b, c = 1, -x, w, z, -y
    elif abs(y) >= abs(z):
        face, top, a, b, c = 2, -y, -z, w, x
    else:
        face, top, a, b, c = 3, -z, y, -x, w
    face = 0 if faces == 1 else face
    cell = (face * cells + _step(a, top, cells)) * cells + _step(b, top, cells)
    return cell * cells + _step(c, top, cells)


@kernel
def matrix_quaternion(r00, r01, r02, r10, r11, r12, r20, r21, r22):
    """A multiple of the quaternion (x, y, z, w) of a rotation matrix, after Shepperd (1978)."""
    trace = r00 + r11 + r22
    if trace >= r00 and trace >= r11 and trace >= r22:
        return r21 - r12, r02 - r20, r10 - r01, 1.0 + trace
    if r00 >= r11 and r00 >= r22:
        return 1.0 + r00 - r11 - r22, r10 + r01, r02 + r20, r21 - r12
    if r11 >= r22:
        return r10 + r01, 1.0 + r11 - r00 - r22, r21 + r12, r02 - r20
    return r02 + r20, r21 + r12, 1.0 + r22 - r00 - r11, r10 - r01


@inlined
def _column(f, link, k):
    """Column ``k`` of the rotation of the table's frame in the world."""
    t = LINK_TURN + k
    a, b, c = link[t], link[t + 3], link[t + 6]
    return (
        f[0] * a + f[1] * b + f[2] * c,
        f[3] * a + f[4] * b + f[5] * c,
        f[6] * a + f[7] * b + f[8] * c,
    )


@kernel
def orientation_cell(table, link, f):
    """The cell of orientations of a body with frame ``f``."""
    vector, faces, cells = int(table[VECTOR]), int(table[FACES]), int(table[CELLS])
    if vector == 2:
        x, y, _ = _column(f, link, 0)
        return heading_cell(x, y, faces, cells)
    if vector == 3:
        x, y, z = _column(f, link, 2)
        return direction_cell(x, y, z, faces, cells)
    if vector == 4:
        r00, r10, r20 = _column(f, link, 0)
        r01, r11, r21 = _column(f, link, 1)
        r02, r12, r22 = _column(f, link, 2)
        qx, qy, qz, qw = matrix_quaternion(r00, r01, r02, r10, r11, r12, r20, r21, r22)
        return quaternion_cell(qx, qy, qz, qw, faces, cells)
    return 0


@kernel
def link_is_safe(tables, link, f, offsets, intervals):
    """Whether the tables prove a body with frame ``f`` safe; False says nothing."""
    if link[LINK_TABLE] < 0.0:
        return False
    table = tables[int(link[LINK_TABLE])]
    m = LINK_MIDDLE
    x = f[9] + (f[0] * link[m] + f[1] * link[m + 1] + f[2] * link[m + 2])
    y = f[10] + (f[3] * link[m] + f[4] * link[m + 1] + f[5] * link[m + 2])
    z = f[11] + (f[6] * link[m] + f[7] * link[m + 1] + f[8] * link[m + 2])
    if not (
        x >= table[LOW] and x < table[HIGH]
        and y >= table[LOW + 1] and y < table[HIGH + 1]
        and z >= table[LOW + 2] and z < table[HIGH + 2]
    ):  # fmt: skip
        return (
            x < table[SAFE_LOW] or x > table[SAFE_HIGH]
            or y < table[SAFE_LOW + 1] or y > table[SAFE_HIGH + 1]
            or z < table[SAFE_LOW + 2] or z > table[SAFE_HIGH + 2]
        )  # fmt: skip
    line = orientation_cell(table, link, f)
    axis, along = int(table[AXIS]), 0.0
    for k in range(3):
        away = (x if k == 0 else (y if k == 1 else z)) - table[LOW + k]
        if k == axis:
            along = away * table[SWEEP]
        else:
            count = int(table[LINES + k])
            line = line * count + min(int(away * table[PER + k]), count - 1)
    line += int(table[FIRST])
    for k in range(offsets[line], offsets[line + 1]):
        if along <= intervals[k, 0]:
            return False
        if along < intervals[k, 1]:
            return True
    return False


@kernel
def tabulated_row_is_free(
    scene, kinematics, book, offsets, intervals, row, frames, placed, order, body
):
    """As articulated_validity.row_is_free, with the exact test only where tables do not tell."""
    if not (
        in_bounds(scene, row[0], row[1], row[2])
        and is_rotation(row[3], row[4], row[5], row[6])
        and within_limits(kinematics, row)
    ):
        return False
    links, tables, members = link_rows(book), table_rows(book), members_of(book)
    body_frames(kinematics, row, frames)
    parts = part_rows(scene)
    place_on_frames(parts, owners_of(kinematics), frames, placed)
    for b in range(links.shape[0]):
        if not link_is_safe(tables, links[b], frames[b], offsets, intervals):
            for k in range(int(members[b]), int(members[b + 1])):
                if not part_is_free(scene, placed, int(members[k])):
                    return False
    return first_self_contact(scene, kinematics, frames, placed, order, body)[0] < 0


@kernel
def tabulated_is_free(scene, kinematics, book, offsets, intervals, row):
    """:func:`tabulated_row_is_free` of one row, with workspaces of its own."""
    return tabulated_row_is_free(
        scene, kinematics, book, offsets, intervals, row,
        new_frames(kinematics), new_placed(scene), new_order(kinematics), new_body(),
    )  # fmt: skip


@kernel
def tabulated_state_is_free(scene, kinematics, book, offsets, intervals, form, states):
    """Whether a state (1, d) is well formed and safe (see kernels.articulated_states)."""
    if not is_well_formed(form, states[0]):
        return False
    row = row_of_state(form, states[0])
    return tabulated_is_free(scene, kinematics, book, offsets, intervals, row)


@kernel
def are_tabulated_free(scene, kinematics, book, offsets, intervals, rows, out):
    """:func:`tabulated_row_is_free` of every row (m, 7 + V)."""
    frames, placed = new_frames(kinematics), new_placed(scene)
    order, body = new_order(kinematics), new_body()
    for k in range(rows.shape[0]):
        out[k] = tabulated_row_is_free(
            scene, kinematics, book, offsets, intervals, rows[k], frames, placed, order, body
        )


@kernel
def table_answers(kinematics, book, offsets, intervals, rows, out):
    """Whether, (m, bodies), the tables alone prove each body of each row (m, 7 + V) safe."""
    links, tables = link_rows(book), table_rows(book)
    frames = new_frames(kinematics)
    for k in range(rows.shape[0]):
        body_frames(kinematics, rows[k], frames)
        for b in range(links.shape[0]):
            out[k, b] = link_is_safe(tables, links[b], frames[b], offsets, intervals)
