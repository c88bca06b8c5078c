# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes, snapshots of everything on a mesh, and measurements of UV maps that share no code with the add-on."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from itertools import pairwise

import bmesh
import bpy
import numpy as np

GROUP = "uv_cones"
ANGLES = "uv_cone_angle"

# Largest error of a UV edge length by rounding both ends to 32-bit floats in the unit square.
UV_ROUNDING = 2e-7

ATTRIBUTE_VALUES = {
    "FLOAT": ("value", np.float32, 1),
    "INT": ("value", np.int32, 1),
    "BOOLEAN": ("value", bool, 1),
    "INT8": ("value", np.int32, 1),
    "FLOAT_VECTOR": ("vector", np.float32, 3),
    "FLOAT2": ("vector", np.float32, 2),
    "FLOAT_COLOR": ("color", np.float32, 4),
    "BYTE_COLOR": ("color", np.float32, 4),
    "INT32_2D": ("value", np.int32, 2),
    "INT16_2D": ("value", np.int32, 2),
}


def add_object(name: str, build: Callable[[bmesh.types.BMesh], None]) -> bpy.types.Object:
    """A new selected, active object whose mesh ``build`` fills."""
    mesh = bpy.data.meshes.new(name)
    bm = bmesh.new()
    build(bm)
    bm.to_mesh(mesh)
    bm.free()
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(obj)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    return obj


def add_cube(name: str = "Cube", cuts: int = 3) -> bpy.types.Object:
    """A cube of side 2 made of (cuts + 1)² quads a side, with one UV layer."""

    def build(bm: bmesh.types.BMesh) -> None:
        bmesh.ops.create_cube(bm, size=2.0)
        bmesh.ops.subdivide_edges(bm, edges=bm.edges, cuts=cuts, use_grid_fill=True)
        bm.loops.layers.uv.new("UVMap")

    return add_object(name, build)


def add_texture(obj: bpy.types.Object, width: int, height: int) -> bpy.types.Image:
    """Gives ``obj`` a material whose active node is an image of ``width`` by ``height`` pixels; returns the image."""
    image = bpy.data.images.new("Texture", width, height)
    material = bpy.data.materials.new("Textured")
    if bpy.app.version < (5, 0):
        material.use_nodes = True
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    material.node_tree.nodes.active = node
    obj.data.materials.append(material)
    return image


def add_sphere(name: str = "Sphere") -> bpy.types.Object:
    """A closed sphere of triangles and quads, with one UV layer."""

    def build(bm: bmesh.types.BMesh) -> None:
        bmesh.ops.create_uvsphere(bm, u_segments=12, v_segments=8, radius=1.0)
        bm.loops.layers.uv.new("UVMap")

    return add_object(name, build)


def add_ball(name: str = "Ball", cuts: int = 3) -> bpy.types.Object:
    """A bumpy ball of quads, its former cube corners as cones: closed, without symmetry."""
    ball = add_cone_cube(name, cuts)
    for vertex in ball.data.vertices:
        x, y, z = vertex.co.normalized()
        vertex.co = vertex.co.normalized() * (1.0 + 0.15 * np.sin(3 * x + 1) * np.cos(2 * y - z))
    return ball


def add_tube(name: str = "Tube", taper: float = 0.3) -> bpy.types.Object:
    """A tapering tube of 16 x 5 quads about z, open at both ends, with one UV layer."""

    def build(bm: bmesh.types.BMesh) -> None:
        rings = [
            [
                bm.verts.new(((1 - taper * t) * np.cos(angle), (1 - taper * t) * np.sin(angle), 2.0 * t))
                for angle in np.linspace(0, 2 * np.pi, 16, endpoint=False)
            ]
            for t in np.linspace(0, 1, 6)
        ]
        for lower, upper in pairwise(rings):
            for i in range(16):
                j = (i + 1) % 16
                bm.faces.new((lower[i], lower[j], upper[j], upper[i]))
        bm.loops.layers.uv.new("UVMap")

    return add_object(name, build)


def add_ramp(name: str = "Ramp", turns: float = 1.75, steps: int = 48) -> bpy.types.Object:
    """A ramp of steps x 4 quads that winds up about z: flattened, it lies on itself beyond one turn."""

    def build(bm: bmesh.types.BMesh) -> None:
        rows = [
            [bm.verts.new((r * np.cos(angle), r * np.sin(angle), 0.05 * angle)) for r in np.linspace(1, 2, 5)]
            for angle in np.linspace(0, 2 * np.pi * turns, steps + 1)
        ]
        for row, following in pairwise(rows):
            for inner in range(4):
                bm.faces.new((row[inner], row[inner + 1], following[inner + 1], following[inner]))
        bm.loops.layers.uv.new("UVMap")

    ramp = add_object(name, build)
    # A cone group without cones.
    mark(ramp, [])
    return ramp


def add_grid(name: str = "Grid", segments: int = 6) -> bpy.types.Object:
    """A flat square of side 2 with segments² quads and one UV layer."""

    def build(bm: bmesh.types.BMesh) -> None:
        bmesh.ops.create_grid(bm, x_segments=segments, y_segments=segments, size=1.0)
        bm.loops.layers.uv.new("UVMap")

    return add_object(name, build)


def corners(obj: bpy.types.Object) -> list[int]:
    """The eight corners of `add_cube`."""
    return [v.index for v in obj.data.vertices if all(abs(abs(x) - 1.0) < 1e-6 for x in v.co)]


def mark(obj: bpy.types.Object, vertices: Iterable[int], group: str = GROUP) -> None:
    """Put vertices into the cone group, in object mode."""
    (obj.vertex_groups.get(group) or obj.vertex_groups.new(name=group)).add(list(vertices), 1.0, "REPLACE")


def add_cone_cube(name: str = "Cube", cuts: int = 3) -> bpy.types.Object:
    cube = add_cube(name, cuts)
    mark(cube, corners(cube))
    return cube


def joined(first: bpy.types.Object, second: bpy.types.Object) -> bpy.types.Object:
    """The first object, with the second one's mesh as a part beside its own."""
    second.location.x = 5
    bpy.ops.object.select_all(action="DESELECT")
    for obj in (first, second):
        obj.select_set(True)
    bpy.context.view_layer.objects.active = first
    bpy.ops.object.join()
    return first


def marked(obj: bpy.types.Object, group: str = GROUP) -> list[int]:
    """Vertices with a weight in the group, read from a copy of the mesh in any mode."""
    if group not in obj.vertex_groups:
        return []
    index = obj.vertex_groups[group].index
    mesh = plain_copy(obj)
    found = [v.index for v in mesh.vertices if any(g.group == index and g.weight > 0 for g in v.groups)]
    bpy.data.meshes.remove(mesh)
    return found


def edit(*objects: bpy.types.Object, select: str = "SELECT") -> None:
    """Enter edit mode on these objects and select or deselect everything."""
    bpy.ops.object.select_all(action="DESELECT")
    for obj in objects:
        obj.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.context.tool_settings.mesh_select_mode = (True, False, False)
    bpy.ops.mesh.select_all(action=select)


def select_elements(obj: bpy.types.Object, kind: str, indices: Iterable[int]) -> None:
    """Select exactly these "verts" or "faces" of a mesh in edit mode."""
    bm = bmesh.from_edit_mesh(obj.data)
    elements = getattr(bm, kind)
    elements.ensure_lookup_table()
    for element in (*bm.verts, *bm.edges, *bm.faces):
        element.select = False
    for index in indices:
        elements[index].select = True
    bm.select_flush(True)
    bmesh.update_edit_mesh(obj.data)


def mark_seams(obj: bpy.types.Object, pairs: Iterable[tuple[int, int]]) -> None:
    """Mark exactly these vertex pairs as seams, in object mode."""
    wanted = set(pairs)
    for edge in obj.data.edges:
        edge.use_seam = tuple(sorted(edge.vertices)) in wanted


def edges_where(obj: bpy.types.Object, accepts: Callable[[np.ndarray], bool]) -> set[tuple[int, int]]:
    """Vertex pairs of the edges both ends of which are accepted by their position."""
    good = {v.index for v in obj.data.vertices if accepts(np.array(v.co))}
    return {tuple(sorted(edge.vertices)) for edge in obj.data.edges if set(edge.vertices) <= good}


def pin(obj: bpy.types.Object, loops: Iterable[int], uv: np.ndarray | None = None) -> None:
    """Pin these loops in the active layer, in object mode, at these UVs where they are given."""
    layer = obj.data.uv_layers.active
    name = f".pn.{layer.name}"
    flags = obj.data.attributes.get(name) or obj.data.attributes.new(name, "BOOLEAN", "CORNER")
    layer = obj.data.uv_layers.active
    for row, loop in enumerate(loops):
        flags.data[loop].value = True
        if uv is not None:
            layer.uv[loop].vector = uv[row]


def set_uv(obj: bpy.types.Object, uv: np.ndarray) -> None:
    """Overwrite the active layer in object mode; uv: (l, 2)."""
    obj.data.uv_layers.active.uv.foreach_set("vector", np.ascontiguousarray(uv, np.float32).ravel())


def selected(obj: bpy.types.Object) -> list[int]:
    return [v.index for v in bmesh.from_edit_mesh(obj.data).verts if v.select]


def plain_copy(obj: bpy.types.Object) -> bpy.types.Mesh:
    """The mesh as it is now, out of edit mode, so that its attributes can be read."""
    if obj.mode == "EDIT":
        obj.update_from_editmode()
    return obj.data.copy()


def snapshot(obj: bpy.types.Object) -> dict[str, object]:
    """Everything on the object's mesh that an operator could change, by name, as bytes or plain values."""
    mesh = plain_copy(obj)
    state: dict[str, object] = {}
    for attribute in mesh.attributes:
        name, dtype, columns = ATTRIBUTE_VALUES[attribute.data_type]
        values = np.empty(len(attribute.data) * columns, dtype)
        attribute.data.foreach_get(name, values)
        state[f"attribute {attribute.name} {attribute.domain} {attribute.data_type}"] = values.tobytes()
    for owner, name, dtype in (
        ("vertices", "select", bool),
        ("vertices", "hide", bool),
        ("edges", "select", bool),
        ("edges", "hide", bool),
        ("edges", "use_seam", bool),
        ("polygons", "select", bool),
        ("polygons", "hide", bool),
        ("polygons", "loop_start", np.int32),
        ("polygons", "material_index", np.int32),
        ("loops", "vertex_index", np.int32),
        ("loops", "edge_index", np.int32),
    ):
        collection = getattr(mesh, owner)
        values = np.empty(len(collection), dtype)
        collection.foreach_get(name, values)
        state[f"{owner} {name}"] = values.tobytes()
    state["weights"] = [sorted((g.group, g.weight) for g in v.groups) for v in mesh.vertices]
    state["groups"] = [group.name for group in obj.vertex_groups]
    state["active group"] = obj.vertex_groups.active_index
    state["uv layers"] = [layer.name for layer in obj.data.uv_layers]
    state["active uv layer"] = obj.data.uv_layers.active_index
    state["render uv layer"] = [layer.active_render for layer in obj.data.uv_layers]
    state["materials"] = [material and material.name for material in obj.data.materials]
    state["modifiers"] = [(modifier.name, modifier.type) for modifier in obj.modifiers]
    keys = mesh.shape_keys.key_blocks if mesh.shape_keys else ()
    state["shape keys"] = {key.name: [tuple(point.co) for point in key.data] for key in keys}
    state["mode"] = (obj.mode, tuple(bpy.context.tool_settings.mesh_select_mode))
    state["matrix"] = [tuple(row) for row in obj.matrix_world]
    bpy.data.meshes.remove(mesh)
    state["data-blocks"] = sorted(
        (kind, block.name)
        for kind in ("objects", "meshes", "scenes", "materials", "images", "shape_keys", "collections")
        for block in getattr(bpy.data, kind)
    )
    state["context"] = (bpy.context.mode, bpy.context.scene.name, getattr(bpy.context.object, "name", None))
    state["selected objects"] = sorted(selected.name for selected in bpy.context.selected_objects)
    return state


def changed(before: dict[str, object], after: dict[str, object]) -> set[str]:
    """Names of what differs between two snapshots."""
    return {name for name in before.keys() | after.keys() if before.get(name) != after.get(name)}


def uv_key(layer: str = "UVMap") -> str:
    """The name of a UV layer in a snapshot."""
    return f"attribute {layer} CORNER FLOAT2"


class UvMap:
    """The active UV layer of an object with the mesh it lies on, as arrays.

    uv (l, 2) and vertex (l,) of every loop; positions (n, 3); loops_of_face; triangles (t, 3), as loops, and the face
    of each. sides: for each edge with two faces the loop pairs of both sides, in the same vertex order.
    """

    def __init__(self, obj: bpy.types.Object) -> None:
        mesh = plain_copy(obj)
        layer = mesh.uv_layers[obj.data.uv_layers.active.name]
        self.uv = np.array([tuple(entry.vector) for entry in layer.uv], np.float64)
        self.vertex = np.array([loop.vertex_index for loop in mesh.loops])
        self.positions = np.array([tuple(v.co) for v in mesh.vertices], np.float64)
        self.loops_of_face = [list(face.loop_indices) for face in mesh.polygons]
        mesh.calc_loop_triangles()
        self.triangles = np.array([tuple(triangle.loops) for triangle in mesh.loop_triangles])
        self.face_of_triangle = np.array([triangle.polygon_index for triangle in mesh.loop_triangles])
        self.seams = {tuple(sorted(edge.vertices)) for edge in mesh.edges if edge.use_seam}
        pairs: dict[tuple[int, int], list[tuple[int, int]]] = {}
        for loops in self.loops_of_face:
            for first, second in zip(loops, loops[1:] + loops[:1], strict=True):
                if self.vertex[first] > self.vertex[second]:
                    first, second = second, first
                pairs.setdefault((int(self.vertex[first]), int(self.vertex[second])), []).append((first, second))
        self.sides = {edge: sides for edge, sides in pairs.items() if len(sides) == 2}
        bpy.data.meshes.remove(mesh)

    def split_edges(self) -> set[tuple[int, int]]:
        """Vertex pairs of the edges whose two sides lie apart in the map."""
        return {
            edge
            for edge, (left, right) in self.sides.items()
            if not np.array_equal(self.uv[list(left)], self.uv[list(right)])
        }

    def sister_difference(self, edges: Iterable[tuple[int, int]] | None = None) -> float:
        """Largest difference between the UV lengths of the two sides of an edge, of all edges or of these."""
        chosen = self.sides if edges is None else {edge: self.sides[edge] for edge in edges}
        pairs = np.array(list(chosen.values()), int).reshape(-1, 2, 2)
        return float(np.abs(self._length(pairs[:, 0]) - self._length(pairs[:, 1])).max(initial=0.0))

    def edge_shares(self) -> np.ndarray:
        """UV length of a side of every edge by the mean one, edges by their vertices; cuts of one length may be others
        and make the map fit otherwise."""
        lengths = self._length(np.array([self.sides[edge][0] for edge in sorted(self.sides)]))
        return lengths / lengths.mean()

    def scale_spread(self, faces: Iterable[int] | None = None) -> float:
        """Largest over smallest ratio of UV to 3D distance, over all loop pairs of each face; 1 is isometric."""
        ratios = []
        for face in range(len(self.loops_of_face)) if faces is None else faces:
            loops = np.array(self.loops_of_face[face])
            first, second = np.triu_indices(len(loops), 1)
            pairs = np.stack([loops[first], loops[second]], axis=1)
            ends = self.positions[self.vertex[pairs]]
            ratios.append(self._length(pairs) / np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1))
        ratios = np.concatenate(ratios)
        return float(ratios.max() / ratios.min())

    def l2_stretch(self, faces: Iterable[int] | None = None) -> float:
        """The L2 stretch of Sander et al. 2001 over all faces or these; 1 is isometric."""
        chosen = slice(None) if faces is None else np.isin(self.face_of_triangle, list(faces))
        loops = self.triangles[chosen]
        a, b, c = (self.positions[self.vertex[loops[:, i]]] for i in range(3))
        p, q, r = (self.uv[loops[:, i]] for i in range(3))
        sides, flat = np.stack([b - a, c - a], axis=2), np.stack([q - p, r - p], axis=2)
        # Lengths in space of what has length 1 in the map.
        squared = (np.linalg.norm(sides @ np.linalg.inv(flat), axis=(1, 2)) ** 2) / 2
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
        return float(np.sqrt(np.average(squared, weights=area) * np.abs(np.linalg.det(flat)).sum() / 2 / area.sum()))

    def flipped(self) -> set[int]:
        """The faces with a triangle that lies upside down or has no area."""
        return set(self.face_of_triangle[self._areas() <= 0].tolist())

    def overlapping(self) -> set[int]:
        """The faces that lie on others, by more than rounding: no side of either triangle parts the two."""
        z = self._turned_triangles()
        slack = 1e-6 * np.ptp(self.uv)
        low, high = z.view(float).reshape(-1, 3, 2).min(axis=1), z.view(float).reshape(-1, 3, 2).max(axis=1)
        first, second = (
            np.concatenate(ends)
            for ends in zip(
                *(
                    (np.full(len(met), i), met + i + 1)
                    for i in range(len(z))
                    for met in [np.flatnonzero(((low[i + 1 :] < high[i]) & (low[i] < high[i + 1 :])).all(axis=1))]
                ),
                strict=True,
            )
        )
        apart = np.zeros(len(first), bool)
        for one, other in ((z[first], z[second]), (z[second], z[first])):
            for side in range(3):
                start, along = one[:, side], one[:, (side + 1) % 3] - one[:, side]
                depth = ((other - start[:, None]) * along.conj()[:, None]).imag.max(axis=1)
                apart |= depth <= slack * np.abs(along)
        return set(self.face_of_triangle[np.concatenate([first[~apart], second[~apart]])].tolist())

    def overlap_area(self, resolution: int = 600) -> float:
        """Area of all pairs of triangles together as a share of the map's, counted on a raster."""
        z = self._turned_triangles()
        origin = self.uv.min(axis=0) @ (1, 1j)
        z = (z - origin) / np.ptp(self.uv) * resolution
        covered = np.zeros((resolution + 1, resolution + 1))
        for triangle in z:
            x = np.arange(int(triangle.real.min()), int(triangle.real.max()) + 1)
            y = np.arange(int(triangle.imag.min()), int(triangle.imag.max()) + 1)
            middle = x[None, :] + 0.5 + 1j * (y[:, None] + 0.5)
            inside = np.ones(middle.shape, bool)
            for side in range(3):
                inside &= ((middle - triangle[side]) * (triangle[(side + 1) % 3] - triangle[side]).conj()).imag > 0
            covered[y[0] : y[-1] + 1, x[0] : x[-1] + 1] += inside
        return float((covered * (covered - 1)).sum() / 2 / covered.sum())

    def _turned_triangles(self) -> np.ndarray:
        """(t, 3) complex corners, counter-clockwise."""
        z = self.uv[self.triangles] @ (1, 1j)
        return np.where(self._areas()[:, None] < 0, z[:, ::-1], z)

    def _areas(self) -> np.ndarray:
        """(t,), negative where a triangle lies upside down."""
        z = self.uv[self.triangles] @ (1, 1j)
        return ((z[:, 1] - z[:, 0]).conj() * (z[:, 2] - z[:, 0])).imag / 2

    def angle_sum(self, vertex: int) -> float:
        """Sum of the UV angles at a vertex, over all its triangles."""
        triangle, corner = np.nonzero(self.vertex[self.triangles] == vertex)
        here, following, before = (self.triangles[triangle, (corner + step) % 3] for step in range(3))
        along, back = ((self.uv[loops] - self.uv[here]) @ (1, 1j) for loops in (following, before))
        return float(np.angle(back / along).sum())

    def islands(self) -> int:
        """Number of sets of faces connected through edges that are not split."""
        return len(set(self.island_of_face()))

    def island_of_face(self) -> list[int]:
        """For each face, the same number as all faces connected to it through edges that are not split."""
        parent = list(range(len(self.loops_of_face)))

        def root(face: int) -> int:
            while parent[face] != face:
                face = parent[face]
            return face

        face_of = {loop: face for face, loops in enumerate(self.loops_of_face) for loop in loops}
        split = self.split_edges()
        for edge, (left, right) in self.sides.items():
            if edge not in split:
                parent[root(face_of[left[0]])] = root(face_of[right[0]])
        return [root(face) for face in range(len(parent))]

    def border_directions(self) -> np.ndarray:
        """Directions in the map, radians, of the edges with one face."""
        found = []
        for loops in self.loops_of_face:
            for first, second in zip(loops, loops[1:] + loops[:1], strict=True):
                if tuple(sorted((int(self.vertex[first]), int(self.vertex[second])))) not in self.sides:
                    along = self.uv[second] - self.uv[first]
                    found.append(np.arctan2(along[1], along[0]))
        return np.array(found)

    def crossings(
        self, rotation_order: int = 4, but: Collection[tuple[int, int]] = ()
    ) -> list[tuple[complex, complex, float]]:
        """For each split edge the turn and the shift that lead from one side to the other, and the deviation from them.

        The turn is the nearest one of a lattice; all is exact where that is a quarter turn. but: edges that are left
        out, as pairs of vertices in ascending order.
        """
        found = []
        for edge in self.split_edges() - set(but):
            left, right = (self.uv[list(loops)] @ (1, 1j) for loops in self.sides[edge])
            turns = np.angle((right[1] - right[0]) / (left[1] - left[0])) * rotation_order / (2 * np.pi)
            quarters = round(turns) * 4 / rotation_order
            exact = quarters.is_integer()
            turn = [1, 1j, -1, -1j][int(quarters) % 4] if exact else np.exp(0.5j * np.pi * quarters)
            shift = right[0] - turn * left[0]
            found.append((complex(turn), complex(shift), float(abs(right[1] - turn * left[1] - shift))))
        return found

    def tile_error(self, rotation_order: int = 4, cell: float = 1.0, but: Collection[tuple[int, int]] = ()) -> float:
        """How far split edges are from one turn and one shift by whole cells of the lattice; 0 is seamless."""
        second = np.exp(1j * np.pi / 3) if rotation_order in (3, 6) else 1j
        worst = 0.0
        for _, shift, missed in self.crossings(rotation_order, but):
            rows = round(shift.imag / second.imag / cell)
            columns = round((shift - rows * second * cell).real / cell)
            worst = max(worst, missed, abs(shift - cell * (columns + rows * second)))
        return worst

    def _length(self, pairs: np.ndarray) -> np.ndarray:
        return np.linalg.norm(self.uv[pairs[:, 0]] - self.uv[pairs[:, 1]], axis=1)


def coverage(triangles: np.ndarray, resolution: int) -> np.ndarray:
    """(resolution, resolution), in how many triangles, (t, 3) complex, each point of a raster of the square lies."""
    # Points on an edge that two triangles share are in both of them by rounding: no edge in a usual place has any.
    across, up = ((np.arange(resolution) + offset) / resolution for offset in (0.37, 0.61))
    count = np.zeros((resolution, resolution), int)
    for corners in triangles:
        left, right = np.searchsorted(across, (corners.real.min(), corners.real.max()))
        low, high = np.searchsorted(up, (corners.imag.min(), corners.imag.max()))
        points = across[None, left:right] + 1j * up[low:high, None]
        sides = [((points - a) * np.conj(b - a)).imag > 0 for a, b in zip(corners, np.roll(corners, -1), strict=True)]
        count[low:high, left:right] += np.all(sides, axis=0)
    return count


def covered_twice(maps: Iterable[UvMap], resolution: int = 400) -> int:
    """How many points of a raster in the unit square lie in more than one triangle of these maps."""
    triangles = np.concatenate([uv_map._turned_triangles() for uv_map in maps])
    return int((coverage(triangles, resolution) > 1).sum())
