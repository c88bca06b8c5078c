# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh file in, the same file with texture coordinates out, in every format that `mesh_formats` has."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..base.arguments import IndexArray
from ..base.short_repr import ShortRepr
from ..errors import Finding, InputError
from ..stitching import at_stitched, in_own_faces, stitched_cones, stitched_finding, stitched_vertices, without_stitched
from ..surface import Surface
from .mesh_formats import FORMATS, GLB, GLTF, OBJ, OFF, PLY, STL, Format, input_format, output_format
from .mesh_gltf import edit_gltf, new_gltf, read_gltf
from .mesh_obj import format_obj, read_obj
from .mesh_obj_edit import edit_obj
from .mesh_off import read_off
from .mesh_ply import read_ply
from .mesh_ply_write import format_ply
from .mesh_stl import read_stl
from .mesh_text import quoted
from .polygons import PolygonMesh, Triangulation, triangulate
from .repeated_corners import not_covered, without_repeated_corners
from .safe_files import is_same_file, require_separate
from .side_files import UsageError, read_regular
from .whole_files import content_digest, write_whole

# By lower-case suffix: files that hold meshes, whether they can be read or not.
MESH_SUFFIXES = frozenset(form.suffix for form in FORMATS) | {
    *(".3ds", ".3mf", ".abc", ".blend", ".c4d", ".ctm", ".dae", ".dxf", ".fbx", ".iges", ".igs", ".lwo", ".ma"),
    *(".max", ".mb", ".mesh", ".msh", ".step", ".stp", ".usd", ".usda", ".usdc", ".usdz", ".vtk", ".vtp", ".vtu"),
    *(".wrl", ".x3d"),
}
GLTF_FORMS = (GLTF, GLB)
NAMED_EXTRAS = 8
# Of a file beside a document: no system has longer paths.
LONGEST_NAME = 1 << 15


@dataclass(frozen=True, eq=False, repr=False)
class MeshFile(ShortRepr):
    """A mesh file that has been read, with everything needed to write it again.

    path: None for standard input. format, data: its format and its bytes.
    mesh: its vertices and polygons. triangulation: their triangles, and which polygons and corners they are of.
    stitched: (n,) int32, for each vertex the one that stands for it in the triangles, as by `stitch_borders`; itself
        for most. findings: what was left out or stitched.
    """

    path: Path | None
    format: Format
    data: bytes
    mesh: PolygonMesh
    triangulation: Triangulation
    stitched: IndexArray
    findings: tuple[Finding, ...]

    @classmethod
    def of(cls, path: Path | None, form: Format, data: bytes, mesh: PolygonMesh, stitch: bool = True) -> MeshFile:
        """A file from its parsed content.  Raises InputError: BAD_FACE."""
        stitched = np.arange(len(mesh.positions), dtype=np.int32)
        if stitch:
            stitched = stitched_vertices(mesh.positions, mesh.corners, mesh.sizes)
        triangulation, findings = triangulated(mesh)
        triangulation = triangulation.at_vertices(stitched)
        return cls(path, form, data, mesh, triangulation, stitched, (*findings, *stitched_finding(stitched)))

    @property
    def triangle_uv(self) -> NDArray[np.float64] | None:
        """(m, 3, 2) the texture coordinates that the file has, NaN at corners without; None where its format is not
        read with them or it was read without."""
        return None if self.mesh.corner_uv is None else self.mesh.corner_uv[self.triangulation.corner]

    def surface(self, seam_edges: ArrayLike = (), importance: ArrayLike | None = None) -> Surface:
        """What the verbs of the library take.  Arguments, with the vertices of the file, and errors as of `Surface`."""
        seams = at_stitched(self.stitched, np.asarray(seam_edges, np.int32).reshape(-1, 2))
        shape = self.mesh.positions, self.triangulation.triangles, self.triangulation.edges
        return Surface(*shape, seams, importance, may_collapse=True)

    def cones(
        self, cones: IndexArray, angles: Sequence[float | None] | None
    ) -> tuple[IndexArray, list[float | None] | None]:
        """Cones at vertices of the file, and their angles, as they are on the surface."""
        stitched, rows = stitched_cones(self.stitched, cones)
        return stitched, None if angles is None else [angles[row] for row in rows]

    @property
    def named_files(self) -> list[Path]:
        """The files that belong to it, by its own words: buffers, images, materials. Of whole paths, which may lead to
        another computer, none."""
        if self.path is None:
            return []
        return [self.path.parent / name for name in self.mesh.named if "\0" not in name and not Path(name).anchor]

    def told(self, warnings: Sequence[Finding]) -> list[Finding]:
        """All findings of a run on this file, with warnings on its surface."""
        return [*self.findings, *without_stitched(self.stitched, warnings)]


def read_mesh(path: str | os.PathLike[str], with_uv: bool = False) -> PolygonMesh:
    """The vertices and polygons alone.  Raises as `read_mesh_file`."""
    return parse_mesh(Path(path), read_regular(Path(path)), with_uv=with_uv)[1]


def read_mesh_file(path: str | os.PathLike[str], with_uv: bool = False, *, stitch: bool = True) -> MeshFile:
    """Read a mesh file: OBJ, OFF, PLY, glTF, GLB, STL.

    Vertices are those of the file, in its order; of STL and glTF, which repeat them, each place once. Polygons are cut
    into triangles.
    with_uv: read texture coordinates as well, of OBJ and glTF.
    stitch: boundaries that coincide are stitched, as by `stitch_borders`; `MeshFile.stitched` has the vertices
        that the surface has instead of others, cones for instance.
    Raises OSError; InputError: UNKNOWN_FORMAT, MALFORMED_FILE, INDEX_OUT_OF_RANGE, BAD_FACE.
    """
    data = read_regular(Path(path))
    form, mesh = parse_mesh(Path(path), data, with_uv=with_uv)
    return MeshFile.of(Path(path), form, data, mesh, stitch)


def write_mesh_file(
    path: str | os.PathLike[str], file: MeshFile, corner_uv: ArrayLike, in_place: bool = False
) -> list[Finding]:
    """Write a mesh file with texture coordinates: OBJ, glTF, GLB; with the extra `formats` PLY too.

    corner_uv: (m, 3, 2), one (u, v) per corner of the triangles of `file`; NaN where there is none.
    in_place: the path may be that of `file` itself, which must not have changed since it was read.

    In the file's own format everything but the texture coordinates stays as it was; otherwise vertices and polygons
    do, and what else the format cannot hold is in the findings returned. The file is written as a whole or not at all.
    Raises OSError; InputError: WRONG_SHAPE, WRONG_PARAMETER for a format that cannot be written and for a path that is
    the input.
    """
    uv = np.asarray(corner_uv, np.float64)
    expected = (len(file.triangulation.triangles), 3, 2)
    if uv.shape != expected:
        raise InputError("WRONG_SHAPE", f"corner_uv has shape {uv.shape}; pass {expected}, one (u, v) per corner.")
    try:
        form = output_format(path)
        if file.path is not None:
            require_separate(file.path, Path(path), in_place=in_place)
    except UsageError as error:
        raise InputError("WRONG_PARAMETER", f"{str(error)[0].upper()}{str(error)[1:]}.") from error
    data, findings = format_mesh(file, uv, form, Path(path).parent)
    is_itself = in_place and file.path is not None and is_same_file(file.path, path)
    write_whole(path, data, keep_backup=in_place, was=content_digest(file.data) if is_itself else None)
    return list(findings)


def parse_mesh(
    path: Path | None, data: bytes, given: str | None = None, *, with_uv: bool = False
) -> tuple[Format, PolygonMesh]:
    """The format and the mesh of a file's content.  path, given: as for `input_format`.  Raises as `read_mesh_file`."""
    form = input_format(path, data, given)
    readers: dict[Format, Callable[[], PolygonMesh]] = {
        OBJ: lambda: read_obj(data, with_uv),
        OFF: lambda: read_off(data),
        PLY: lambda: read_ply(data),
        GLTF: lambda: read_gltf(data, _beside(path), with_uv),
        GLB: lambda: read_gltf(data, _beside(path), with_uv),
        STL: lambda: read_stl(data),
    }
    return form, readers[form]()


def triangulated(mesh: PolygonMesh) -> tuple[Triangulation, tuple[Finding, ...]]:
    """The triangles of the polygons that can be used, and what was left out.  Raises InputError: BAD_FACE."""
    left_out = np.empty(0, np.int32)
    while True:
        usable = without_repeated_corners(mesh, left_out)
        triangulation = triangulate(usable.mesh)
        uncovered = usable.places_of(not_covered(usable.mesh, triangulation))
        if not len(uncovered):
            return usable.in_whole_mesh(triangulation), usable.findings
        left_out = np.concatenate([left_out, uncovered])


def format_mesh(
    file: MeshFile, corner_uv: NDArray[np.float64], form: Format, folder: Path | None
) -> tuple[bytes, tuple[Finding, ...]]:
    """The content of a file of this format, to be written into the folder, with coordinates (m, 3, 2), and what it
    lacks.

    folder: None for standard output.
    """
    corner_uv = in_own_faces(corner_uv, file.triangulation.triangles, file.triangulation.polygon)
    polygon_uv = file.triangulation.to_polygon_corners(corner_uv, len(file.mesh.corners))
    if form in GLTF_FORMS and file.format in GLTF_FORMS:
        elsewhere = file.path is not None and folder is not None and not is_same_file(file.path.parent, folder)
        return edit_gltf(file.data, _beside(file.path), polygon_uv, binary=form == GLB, with_images=elsewhere)
    if form == OBJ and file.format == OBJ:
        return edit_obj(file.data, file.mesh, polygon_uv), ()
    lost = () if form == file.format else _not_kept(file, form)
    if form == OBJ:
        return format_obj(file.mesh, polygon_uv), lost
    if form == PLY:
        data, further = format_ply(file.mesh, polygon_uv, file.data if file.format == PLY else None)
        return data, lost + further
    data, further = new_gltf(file.mesh.positions, file.triangulation.triangles, corner_uv, binary=form == GLB)
    return data, lost + further


def _not_kept(file: MeshFile, form: Format) -> tuple[Finding, ...]:
    """Warnings of content that another format cannot hold."""
    extras = list(file.mesh.extras)
    if form in GLTF_FORMS and (file.mesh.sizes > 3).any():
        extras.append("polygons of more than three corners, which are cut into triangles")
    if not extras:
        return ()
    rest = f" and {len(extras) - NAMED_EXTRAS} more" if len(extras) > NAMED_EXTRAS else ""
    return (
        Finding(
            "CONTENT_NOT_KEPT",
            f"The {file.format.name} file has more than {form.name} is written with; left behind: "
            f"{', '.join(extras[:NAMED_EXTRAS])}{rest}. Write {file.format.name} to keep all, where it can be written.",
        ),
    )


def _beside(path: Path | None) -> Callable[[str], bytes]:
    """Reads files that a document names, each once.

    What is read ends up in the output, and documents come from anywhere, so they get nothing from outside their folder,
    by links neither.
    """
    found: dict[Path, bytes] = {}

    def read(uri: str) -> bytes:
        named = quoted(uri[:LONGEST_NAME].encode("utf-8", "surrogatepass"))
        if path is None:
            raise InputError(
                "MALFORMED_FILE", f"The document needs {named}, which is not beside standard input. Give its path."
            )
        if "\0" in uri or len(uri) > LONGEST_NAME:
            raise ValueError(f"{named} cannot be the name of a file")
        place = Path(os.path.normpath(uri))
        real = Path(os.path.realpath(path.parent / place))
        if place.anchor or ".." in place.parts or not real.is_relative_to(os.path.realpath(path.parent)):
            raise InputError(
                "MALFORMED_FILE", f"The document needs {named}, which is outside its folder. Copy that file beside it."
            )
        if real not in found:
            found[real] = read_regular(real)
        return found[real]

    return read
