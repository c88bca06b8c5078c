# SPDX-License-Identifier: GPL-3.0-or-later
"""What the operators share: when they can run and which vertex group holds the cones."""

import bpy

from .. import native
from ..identifiers import CONE_GROUP
from ..mesh_read import Region, read_all, read_region
from ..reporting import Refused

# Identifier: (value for the library, label, description).
SEAMS = {
    "FOLLOW": ("follow", "Follow", "Cuts run along marked seams wherever they can; both sides of a cut match"),
    "BOUNDARY": ("boundary", "Boundary", "Every marked seam is an open border, as in Blender's own unwrap"),
    "IGNORE": ("ignore", "Ignore", "Marked seams have no say in where the cuts run"),
}
BORDERS = {
    "FREE": ("free", "Free", "Borders take the shape of least distortion; a cone with an angle there is a corner"),
    "STRAIGHT": ("straight", "Straight", "Borders run straight from cone to cone: a cylinder becomes a strip"),
}

NO_FACES = "the mesh has no faces; add some or select another object"


def enum_items(choices: dict[str, tuple[str | None, str, str]]) -> list[tuple[str, str, str]]:
    """Items of an enum property for choices of the library."""
    return [(identifier, label, description) for identifier, (_, label, description) in choices.items()]


class ConeGroupProperty:
    """Mix-in: the vertex group whose members are the cones."""

    vertex_group: bpy.props.StringProperty(
        name="Cone Group",
        description="Vertex group that holds the cones; a weight above zero marks a vertex as a cone",
        default=CONE_GROUP,
    )

    def draw_vertex_group(self, layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
        """The field with the active object's groups to choose from, where there is an active object."""
        if context.object is None:
            layout.prop(self, "vertex_group")
        else:
            layout.prop_search(self, "vertex_group", context.object, "vertex_groups")


class SeamsProperty:
    """Mix-in: what marked seams mean."""

    seams: bpy.props.EnumProperty(
        name="Seams", description="What edges marked as seams mean for the cuts", items=enum_items(SEAMS)
    )


class BorderProperty:
    """Mix-in: the shape of the mesh's own borders."""

    border: bpy.props.EnumProperty(
        name="Borders", description="The shape of the mesh's own borders", items=enum_items(BORDERS)
    )


def poll_edit_mesh(operator: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """True where a mesh is in edit mode."""
    if context.mode != "EDIT_MESH":
        operator.poll_message_set("Enter edit mode on a mesh first")
        return False
    return True


def poll_computation(operator: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """True where the computing library is there and meshes are in edit mode or selected in object mode."""
    if native.PROBLEM:
        operator.poll_message_set(native.PROBLEM)
        return False
    if context.mode == "EDIT_MESH":
        return True
    if context.mode != "OBJECT" or not any(obj.type == "MESH" for obj in context.selected_objects):
        operator.poll_message_set("Enter edit mode on a mesh, or select mesh objects in object mode")
        return False
    return True


def require_region(obj: bpy.types.Object, by_uv: bool = False) -> Region | None:
    """The region to work on; None where an edit-mode mesh has nothing selected.  Raises Refused.

    by_uv: as in `read_region`.
    """
    require_editable(obj)
    region = read_region(obj, by_uv)
    if region is None and obj.mode != "EDIT":
        raise Refused(NO_FACES)
    return region


def require_all(obj: bpy.types.Object) -> Region:
    """All faces of a mesh.  Raises Refused."""
    require_editable(obj)
    region = read_all(obj)
    if region is None:
        raise Refused(NO_FACES)
    return region


def require_editable(obj: bpy.types.Object) -> None:
    """Raises Refused where the mesh is another file's."""
    if not obj.data.is_editable:
        raise Refused("the mesh is linked from another file and cannot be changed; make it local (Object > Relations)")
