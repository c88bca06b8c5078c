# SPDX-License-Identifier: GPL-3.0-or-later
"""glTF and GLB: read as one mesh, written with new texture coordinates and all else as it was."""

from __future__ import annotations

import json
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from gltf_files import Builder, content_of, corners_of, scene, soup, values_of
from lsgp.errors import InputError
from lsgp.io import gltf_document, mesh_gltf
from lsgp.io.mesh_files import read_mesh_file, write_mesh_file
from polygon_meshes import bumpy_ball, obj_text


def in_file(folder: Path, data: bytes, name: str) -> Path:
    path = folder / name
    path.write_bytes(data)
    return path


def some_uv(count: int) -> np.ndarray:
    """A coordinate for every corner, different at every one, that single precision holds."""
    return np.arange(6.0 * count).reshape(count, 3, 2) / 1024


@pytest.mark.parametrize("form", ["gltf", "glb"])
def test_meshes_are_read_where_their_nodes_put_them_and_welded(tmp_path: Path, form: str) -> None:
    b = scene()
    file = read_mesh_file(in_file(tmp_path, getattr(b, form)(), f"a.{form}"))
    corners, _, triangles = soup()
    places = file.mesh.positions[file.triangulation.triangles]
    count = len(corners)
    moved = corners.astype(float) + np.array([5, 0, 0])
    expected = np.stack([-3 * moved[..., 1], 2 * moved[..., 0], 4 * moved[..., 2]], axis=-1)
    assert np.abs(places[:count] - expected).max() < 1e-12
    assert len(np.unique(file.triangulation.triangles[:count])) == len(np.unique(triangles))
    assert len(file.mesh.positions) == len(np.unique(triangles)) + 4
    normal = np.cross(places[count:, 1] - places[count:, 0], places[count:, 2] - places[count:, 0])
    assert (normal[:, 2] > 0).all()  # a mirrored mesh does not turn over


def test_positions_are_rounded_alike_on_every_processor(tmp_path: Path) -> None:
    """They are sums in one order, without the fused operations that some processors have."""
    corners, _, _ = soup()
    points, (x, y, z, w) = corners.reshape(-1, 3), (0.2, 0.4, 0.4, 0.8)
    b = Builder()
    b.content |= {
        "nodes": [{"mesh": 0, "rotation": [x, y, z, w], "scale": [0.1, 0.3, 0.7], "translation": [0.2, 0.6, 0.9]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": b.add(points)}}]}],
    }
    file = read_mesh_file(in_file(tmp_path, b.gltf(), "a.gltf"))
    matrix = [
        [(1 - 2 * (y * y + z * z)) * 0.1, 2 * (x * y - z * w) * 0.3, 2 * (x * z + y * w) * 0.7],
        [2 * (x * y + z * w) * 0.1, (1 - 2 * (x * x + z * z)) * 0.3, 2 * (y * z - x * w) * 0.7],
        [2 * (x * z - y * w) * 0.1, 2 * (y * z + x * w) * 0.3, (1 - 2 * (x * x + y * y)) * 0.7],
    ]
    expected = [
        [a * p + b * q + c * r + moved for (a, b, c), moved in zip(matrix, (0.2, 0.6, 0.9), strict=True)]
        for p, q, r in points.astype(float).tolist()
    ]
    assert file.mesh.positions[file.triangulation.triangles].reshape(-1, 3).tolist() == expected


@pytest.mark.parametrize("form", ["gltf", "glb"])
@pytest.mark.parametrize("written", ["gltf", "glb"])
def test_everything_but_texture_coordinates_stays(tmp_path: Path, form: str, written: str) -> None:
    b = scene()
    before = getattr(b, form)()
    file = read_mesh_file(in_file(tmp_path, before, f"a.{form}"))
    uv = some_uv(len(file.triangulation.triangles))
    findings = write_mesh_file(tmp_path / f"out.{written}", file, uv)
    after = (tmp_path / f"out.{written}").read_bytes()
    assert [finding.code for finding in findings] == ["CONTENT_NOT_KEPT"]
    assert "Tangents" in findings[0].message

    old, new = b.content, content_of(after)[0]
    assert old.keys() - {"buffers"} == new.keys() - {"buffers"}
    for key in old.keys() - {"accessors", "bufferViews", "buffers", "meshes"}:
        assert new[key] == old[key], key
    assert new["meshes"][1]["primitives"][2] == old["meshes"][1]["primitives"][2]
    for sampler in new["animations"][0]["samplers"]:
        for accessor in sampler.values():
            assert (values_of(after, accessor) == values_of(b.glb(), accessor)).all()

    for mesh, primitive, part in ((0, 0, slice(0, 54)), (0, 1, slice(54, 108)), (1, 0, [108]), (1, 1, [109])):
        was, now = (content["meshes"][mesh]["primitives"][primitive] for content in (old, new))
        assert now.keys() == was.keys() | {"indices"}
        assert [now[key] for key in ("material", "extras") if key in now] == [
            was[key] for key in ("material", "extras") if key in was
        ]
        assert now["attributes"].keys() == (was["attributes"].keys() - {"TANGENT"}) | {"TEXCOORD_0"}
        stored = corners_of(after, mesh, primitive, "TEXCOORD_0")
        assert (stored == np.stack([uv[part][..., 0], 1 - uv[part][..., 1]], axis=-1).astype("<f4")).all()
        source = b.glb()
        index = values_of(source, was["indices"])[:, 0] if "indices" in was else slice(None)
        for name in now["attributes"].keys() - {"TEXCOORD_0"}:
            values = values_of(source, was["attributes"][name])[index]
            assert (corners_of(after, mesh, primitive, name).reshape(values.shape) == values).all(), name
        accessor = new["accessors"][now["attributes"]["POSITION"]]
        points = values_of(after, now["attributes"]["POSITION"])
        assert (accessor["min"], accessor["max"]) == (points.min(axis=0).tolist(), points.max(axis=0).tolist())
    targets = new["meshes"][0]["primitives"][0]["targets"][0]["POSITION"]
    indices = values_of(after, new["meshes"][0]["primitives"][0]["indices"])[:, 0]
    assert (values_of(after, targets)[indices].reshape(-1, 3, 3) == 2 * soup()[0][:54]).all()
    assert len(after) < 3 * len(before)


def test_vertices_are_split_at_cuts_only(tmp_path: Path) -> None:
    b = Builder()
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "<f4")
    position = b.add(points, min=[0, 0, 0], max=[1, 1, 0])
    indices = b.add(np.array([0, 1, 2, 0, 2, 3], np.uint8))
    b.content["meshes"] = [{"primitives": [{"attributes": {"POSITION": position}, "indices": indices}]}]
    file = read_mesh_file(in_file(tmp_path, b.glb(), "a.glb"))
    uv = points[[[0, 1, 2], [0, 2, 3]]][..., :2].astype(float)
    write_mesh_file(tmp_path / "whole.glb", file, uv)
    uv[1, 0] += 1
    write_mesh_file(tmp_path / "cut.glb", file, uv)
    counts = [content_of((tmp_path / f"{n}.glb").read_bytes())[0]["accessors"][0]["count"] for n in ("whole", "cut")]
    assert counts == [4, 5]


def test_triangles_that_are_not_solved_keep_what_they_have(tmp_path: Path) -> None:
    for with_uv in (True, False):
        file = read_mesh_file(in_file(tmp_path, scene(with_uv=with_uv).glb(), "a.glb"), with_uv=True)
        uv = some_uv(len(file.triangulation.triangles))
        uv[3, 1] = np.nan
        findings = write_mesh_file(tmp_path / "out.glb", file, uv)
        stored = corners_of((tmp_path / "out.glb").read_bytes(), 0, 0, "TEXCOORD_0")
        assert (stored[3] == ([0.25, 0.25] if with_uv else [0, 1])).all()
        assert ("UNSOLVED_AT_ORIGIN" in [finding.code for finding in findings]) == (not with_uv)
        again = read_mesh_file(tmp_path / "out.glb", with_uv=True).triangle_uv
        assert np.abs(again[3] - ([0.25, 0.75] if with_uv else [0, 0])).max() == 0
        assert np.abs(np.delete(again, 3, axis=0) - np.delete(uv, 3, axis=0)).max() < 1e-6


def test_files_beside_a_document_are_found_and_taken_along(tmp_path: Path) -> None:
    b = scene()
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "data 1.bin").write_bytes(b.buffer)
    (tmp_path / "in" / "stone.png").write_bytes(b"\x89PNG")
    b.content |= {
        "buffers": [{"byteLength": len(b.buffer), "uri": "data%201.bin"}],
        "images": [{"uri": "stone.png"}, {"uri": "missing.png"}],
    }
    file = read_mesh_file(in_file(tmp_path / "in", json.dumps(b.content).encode(), "a.gltf"))
    uv = some_uv(len(file.triangulation.triangles))
    write_mesh_file(tmp_path / "in" / "near.gltf", file, uv)
    write_mesh_file(tmp_path / "far.gltf", file, uv)
    near, far = (json.loads((tmp_path / name).read_text())["images"] for name in ("in/near.gltf", "far.gltf"))
    assert near == [{"uri": "stone.png"}, {"uri": "missing.png"}]
    assert far == [{"uri": "data:image/png;base64,iVBORw=="}, {"uri": "missing.png"}]


@pytest.mark.parametrize("kind", ["above", "absolute", "detour"])
def test_nothing_outside_the_folder_of_a_document_gets_into_a_result(tmp_path: Path, kind: str) -> None:
    """Documents come from anywhere, and what they name is written into the output."""
    b = scene()
    secret = tmp_path / "secret"
    secret.write_bytes(b.buffer)
    (tmp_path / "in").mkdir()
    uri = {"above": "../secret", "absolute": secret.as_posix(), "detour": "maps/%2E%2E/../secret"}[kind]
    buffers = [{"byteLength": len(b.buffer), "uri": uri}]
    path = in_file(tmp_path / "in", json.dumps(b.content | {"buffers": buffers}).encode(), "a.gltf")
    with pytest.raises(InputError, match="outside its folder") as caught:
        read_mesh_file(path)
    assert caught.value.code == "MALFORMED_FILE"

    b.content["images"] = [{"uri": uri}]
    file = read_mesh_file(in_file(tmp_path / "in", b.gltf(), "b.gltf"))
    findings = write_mesh_file(tmp_path / "far.gltf", file, some_uv(len(file.triangulation.triangles)))
    assert json.loads((tmp_path / "far.gltf").read_text())["images"] == [{"uri": uri}]
    (about_images,) = [finding for finding in findings if "Images" in finding.message]
    assert about_images.code == "CONTENT_NOT_KEPT"


@pytest.mark.parametrize("of_folder", [False, True])
def test_links_do_not_lead_out_of_the_folder_of_a_document(tmp_path: Path, of_folder: bool) -> None:
    b = scene()
    (tmp_path / "outside").mkdir()
    (tmp_path / "outside" / "secret").write_bytes(b.buffer)
    (tmp_path / "in").mkdir()
    link = tmp_path / "in" / ("link" if of_folder else "secret")
    try:
        link.symlink_to(tmp_path / "outside" if of_folder else tmp_path / "outside" / "secret")
    except OSError:
        pytest.skip("no links here")
    uri = "link/secret" if of_folder else "secret"
    buffers = [{"byteLength": len(b.buffer), "uri": uri}]
    path = in_file(tmp_path / "in", json.dumps(b.content | {"buffers": buffers}).encode(), "a.gltf")
    with pytest.raises(InputError, match="outside its folder"):
        read_mesh_file(path)
    b.content["images"] = [{"uri": uri}]
    file = read_mesh_file(in_file(tmp_path / "in", b.gltf(), "b.gltf"))
    findings = write_mesh_file(tmp_path / "far.gltf", file, some_uv(len(file.triangulation.triangles)))
    assert json.loads((tmp_path / "far.gltf").read_text())["images"] == [{"uri": uri}]
    assert any("outside the document's folder" in finding.message for finding in findings)


def test_links_within_the_folder_of_a_document_and_to_it_are_followed(tmp_path: Path) -> None:
    b = scene()
    (tmp_path / "in" / "maps").mkdir(parents=True)
    (tmp_path / "in" / "maps" / "data.bin").write_bytes(b.buffer)
    try:
        (tmp_path / "in" / "link.bin").symlink_to("maps/data.bin")
        (tmp_path / "other").symlink_to(tmp_path / "in")
    except OSError:
        pytest.skip("no links here")
    b.content["buffers"] = [{"byteLength": len(b.buffer), "uri": "link.bin"}]
    in_file(tmp_path / "in", json.dumps(b.content).encode(), "a.gltf")
    assert len(read_mesh_file(tmp_path / "other" / "a.gltf").mesh.positions) > 4


def test_files_in_folders_below_that_of_a_document_are_found(tmp_path: Path) -> None:
    b = scene()
    (tmp_path / "in" / "maps").mkdir(parents=True)
    (tmp_path / "in" / "maps" / "stone.png").write_bytes(b"\x89PNG")
    b.content["images"] = [{"uri": "maps/stone.png"}, {"uri": "other/../maps/stone.png"}]
    file = read_mesh_file(in_file(tmp_path / "in", b.gltf(), "a.gltf"))
    write_mesh_file(tmp_path / "far.gltf", file, some_uv(len(file.triangulation.triangles)))
    images = json.loads((tmp_path / "far.gltf").read_text())["images"]
    assert images == [{"uri": "data:image/png;base64,iVBORw=="}] * 2


def test_other_formats_become_glb_and_what_is_lost_is_said(tmp_path: Path, lsgp) -> None:
    positions, faces = bumpy_ball(3)
    text = "mtllib a.mtl\nvn 0 0 1\n" + obj_text(positions, faces)
    (tmp_path / "in.obj").write_text(text)
    done = lsgp("unwrap", "in.obj", "-o", "out.glb", "--report", "report.json")
    assert done.code == 0
    (warning,) = done.report()["warnings"]
    assert warning["code"] == "CONTENT_NOT_KEPT"
    assert all(what in warning["message"] for what in ("mtllib", "vn", "more than three corners"))
    assert lsgp("unwrap", "in.obj", "-o", "out.obj").code == 0
    there, expected = (read_mesh_file(tmp_path / f"out.{kind}", with_uv=True) for kind in ("glb", "obj"))
    assert np.abs(there.triangle_uv - expected.triangle_uv).max() < 1e-6
    assert lsgp("measure", "out.glb").code == 0


def broken(change) -> bytes:
    b = scene()
    change(b.content)
    return b.gltf()


def with_number(text: bytes) -> bytes:
    """A document in which the number of an accessor's elements is this text."""
    return scene().gltf().replace(b'"count": 162', b'"count": ' + text, 1)


MALFORMED = {
    "no JSON": b"{",
    "no object": b"[]",
    "version 1": b'{"asset": {"version": "1.0"}}',
    "GLB cut short": scene().glb()[:100],
    "GLB without content": b"glTF\x02\0\0\0\x0c\0\0\0",
    "view beyond the buffer": broken(lambda c: c["bufferViews"][0].update(byteLength=10**9)),
    "accessor beyond its view": broken(lambda c: c["accessors"][0].update(count=10**9)),
    "negative offset": broken(lambda c: c["accessors"][0].update(byteOffset=-12)),
    "unknown component": broken(lambda c: c["accessors"][0].update(componentType=1)),
    "index beyond the vertices": broken(lambda c: c["accessors"][-4].update(count=3, byteOffset=2)),
    "strips": broken(lambda c: c["meshes"][0]["primitives"][0].update(mode=5)),
    "sparse": broken(lambda c: c["accessors"][0].update(sparse={})),
    "compressed": broken(lambda c: c.update(extensionsRequired=["KHR_draco_mesh_compression"])),
    "attributes that are missing": broken(lambda c: c["meshes"][0]["primitives"][0].pop("attributes")),
    "nodes of text": broken(lambda c: c.update(nodes="x")),
    "matrix too short": broken(lambda c: c["nodes"][2].update(matrix=[1])),
    "signed indices": broken(lambda c: c["accessors"][-4].update(componentType=5122)),
    "indices by floats": broken(lambda c: c["accessors"][-4].update(componentType=5126, count=3)),
    "indices in pairs": broken(lambda c: c["accessors"][-4].update(type="VEC2", count=3)),
    "normalized indices": broken(lambda c: c["accessors"][-4].update(normalized=True)),
    "places in pairs": broken(lambda c: c["accessors"][0].update(type="VEC2")),
    **{
        f"a count of {text[:10]!r}": with_number(text)
        for text in (
            *(
                b"Infinity",
                b"-Infinity",
                b"NaN",
                b"1e400",
                b"1" * 400,
                b"1" * 5000,
                b"162.0",
                b'"162"',
                b"true",
                b"null",
            ),
            *(b"-162", b"0", b"[162]", b"1e2"),
        )
    },
    "a stride that is infinite": broken(lambda c: c["bufferViews"][0].update(byteStride=float("inf"))),
    "a stride below the element": broken(lambda c: c["bufferViews"][0].update(byteStride=4)),
    "a stride of nothing": broken(lambda c: c["bufferViews"][0].update(byteStride=0)),
    "a negative stride": broken(lambda c: c["bufferViews"][0].update(byteStride=-12)),
    "a stride that overflows": broken(lambda c: c["bufferViews"][0].update(byteStride=2**62)),
    "a view before its buffer": broken(lambda c: c["bufferViews"][0].update(byteOffset=-4)),
    "a view of a buffer before the first": broken(lambda c: c["bufferViews"][0].update(buffer=-1)),
    "a buffer by truth": broken(lambda c: c["bufferViews"][0].update(buffer=False)),
    "depth": broken(lambda c: c.update(extras=json.loads("[" * 900 + "]" * 900))),
    "depth without an end": b"[" * 100_000,
    "a name twice": b'{"asset": {"version": "2.0"}, "asset": {"version": "2.0"}}',
    "a version of numbers": broken(lambda c: c.update(asset={"version": 2.0})),
    "a child that is not there": broken(lambda c: c["nodes"][0].update(children=[-1])),
    "a mesh that is not there": broken(lambda c: c["nodes"][1].update(mesh=-1)),
    "a matrix of text": broken(lambda c: c["nodes"][2].update(matrix=["1"] * 16)),
    "a rotation of lists": broken(lambda c: c["nodes"][0].update(rotation=[[0]] * 4)),
    "a scale of truths": broken(lambda c: c["nodes"][0].update(scale=[True] * 3)),
    "accessor without data": broken(
        lambda c: (c["accessors"][0].pop("bufferView"), c["accessors"][0].update(count=9**9))
    ),
}


@pytest.mark.parametrize("name", MALFORMED)
def test_malformed_documents_are_refused(tmp_path: Path, name: str) -> None:
    """And nothing is allocated for what a file only claims to have."""
    path = in_file(tmp_path, MALFORMED[name], "a.glb" if name.startswith("GLB") else "a.gltf")
    tracemalloc.start()
    try:
        with pytest.raises(InputError) as caught:
            read_mesh_file(path)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert caught.value.code == "MALFORMED_FILE"
    assert len(caught.value.message) < 300
    assert peak < 1e6


MALFORMED_BESIDE_THE_MESH = {
    "images of no list": lambda c: c.update(images=5),
    "image of no object": lambda c: c.update(images=[5]),
    "name of an image": lambda c: c.update(images=[{"uri": 7}]),
    "name with a zero": lambda c: c.update(images=[{"uri": "a\0b"}]),
    "morph targets": lambda c: c["meshes"][0]["primitives"][0].update(targets=5),
    "attribute": lambda c: c["meshes"][0]["primitives"][0]["attributes"].update(COLOR_0=999),
    "view": lambda c: c.update(extras={"bufferView": 999}),
    "view before the first": lambda c: c.update(extras={"bufferView": -1}),
    "attribute of fewer elements": lambda c: c["accessors"][2].update(count=3),
    "attribute by truth": lambda c: c["meshes"][0]["primitives"][0]["attributes"].update(COLOR_0=True),
    "attribute of a list": lambda c: c["meshes"][0]["primitives"][0]["attributes"].update(COLOR_0=[2]),
}


@pytest.mark.parametrize("name", MALFORMED_BESIDE_THE_MESH)
def test_documents_that_are_malformed_beside_the_mesh_are_refused(tmp_path: Path, lsgp, name: str) -> None:
    in_file(tmp_path, broken(MALFORMED_BESIDE_THE_MESH[name]), "in.gltf")
    (tmp_path / "far").mkdir()
    done = lsgp("unwrap", "in.gltf", "-o", "far/out.gltf")
    assert done.code == 3
    assert "MALFORMED_FILE" in done.err
    assert not list((tmp_path / "far").iterdir())


def test_nodes_that_are_their_own_children_end(tmp_path: Path) -> None:
    data = broken(lambda c: c["nodes"][1].update(children=[0]))
    assert len(read_mesh_file(in_file(tmp_path, data, "a.gltf")).mesh.positions) > 4


def overlapping(count: int) -> Builder:
    """A document with so many accessors, nearly all of the buffer each."""
    b = Builder()
    position = b.add(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "<f4"))
    b.add(np.arange(100_000, dtype="<u4"))
    b.content["meshes"] = [{"primitives": [{"attributes": {"POSITION": position}}]}]
    for i in range(count):
        b.content["bufferViews"].append({"buffer": 0, "byteOffset": 36 + 4 * i, "byteLength": 390_000})
        b.content["accessors"].append({"bufferView": 2 + i, "count": 97_500, "type": "SCALAR", "componentType": 5125})
    return b


def test_what_views_have_in_common_is_there_once(tmp_path: Path) -> None:
    """In memory and in the file; a short document could stand for any amount of data."""
    count = 200
    b = overlapping(count)
    path = in_file(tmp_path, b.glb(), "a.glb")
    tracemalloc.start()
    try:
        file = read_mesh_file(path)
        write_mesh_file(tmp_path / "out.glb", file, some_uv(1))
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    after = (tmp_path / "out.glb").read_bytes()
    assert len(after) < 1.1 * len(b.glb()) and peak < 10 * len(after)
    for accessor in (1, 2, count // 2, count + 1):
        assert (values_of(after, accessor) == values_of(b.glb(), accessor)).all()


def test_parts_that_share_their_data_are_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mesh_gltf, "SHARED_TRIANGLES", 10_000)
    corners, _, _ = soup(10)
    b = Builder()
    position = b.add(corners.reshape(-1, 3))
    b.content["meshes"] = [{"primitives": [{"attributes": {"POSITION": position}}] * 2}] * 4
    assert len(read_mesh_file(in_file(tmp_path, b.glb(), "a.glb")).triangulation.triangles) == 8 * len(corners)
    b.content["meshes"] *= 10
    with pytest.raises(InputError, match="triangles or more") as caught:
        read_mesh_file(in_file(tmp_path, b.glb(), "a.glb"))
    assert caught.value.code == "MALFORMED_FILE"

    monkeypatch.setattr(gltf_document, "SHARED_BYTES", 1 << 22)
    attributes = {f"_{i}": position for i in range(1000)}  # one accessor by many names is copied once
    b.content["meshes"] = [{"primitives": [{"attributes": {"POSITION": position} | attributes}]}]
    file = read_mesh_file(in_file(tmp_path, b.glb(), "a.glb"))
    uv = np.zeros((len(corners), 3, 2))
    write_mesh_file(tmp_path / "out.glb", file, uv)
    assert (tmp_path / "out.glb").stat().st_size < 3 * len(b.glb())
    for name in attributes:
        b.content["accessors"].append(b.content["accessors"][position] | {"name": name})
        attributes[name] = len(b.content["accessors"]) - 1
    b.content["meshes"] = [{"primitives": [{"attributes": {"POSITION": position} | attributes}]}]
    file = read_mesh_file(in_file(tmp_path, b.glb(), "a.glb"))
    with pytest.raises(InputError, match="share data") as caught:
        write_mesh_file(tmp_path / "out.glb", file, uv)
    assert caught.value.code == "MALFORMED_FILE"


def test_a_glb_file_longer_than_it_can_say_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By the data before all of it is put together, and by the JSON, in which are images."""
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "stone.png").write_bytes(bytes(4000))
    for images, longest in (([], len(scene().buffer) // 2), ([{"uri": "stone.png"}], len(scene().glb()) + 4000)):
        b = scene()
        b.content["images"] = images
        file = read_mesh_file(in_file(tmp_path / "in", b.glb(), "a.glb"))
        uv = some_uv(len(file.triangulation.triangles))
        monkeypatch.setattr(gltf_document, "LONGEST_GLB", longest)
        with pytest.raises(InputError, match="Write glTF or OBJ") as caught:
            write_mesh_file(tmp_path / "out.glb", file, uv)
        assert caught.value.code == "WRONG_PARAMETER" and not (tmp_path / "out.glb").exists()
        write_mesh_file(tmp_path / "out.gltf", file, uv)


def test_what_a_shared_accessor_says_is_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gltf_document, "SHARED_BYTES", 1 << 20)
    b = Builder()
    position = b.add(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "<f4"), extras="x" * 100_000)
    b.content["meshes"] = [{"primitives": [{"attributes": {"POSITION": position}}]}] * 20
    file = read_mesh_file(in_file(tmp_path, b.glb(), "a.glb"))
    with pytest.raises(InputError, match="share data"):
        write_mesh_file(tmp_path / "out.glb", file, np.zeros((20, 3, 2)))


def test_one_image_by_many_names_is_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gltf_document, "SHARED_BYTES", 1 << 20)
    b = scene()
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "stone.png").write_bytes(bytes(1 << 18))
    b.content["images"] = [{"uri": "./" * i + "stone.png"} for i in range(20)]
    file = read_mesh_file(in_file(tmp_path / "in", b.gltf(), "a.gltf"))
    with pytest.raises(InputError, match="share data"):
        write_mesh_file(tmp_path / "far.gltf", file, some_uv(len(file.triangulation.triangles)))
    assert not (tmp_path / "far.gltf").exists()


def test_a_compressed_form_of_data_that_changes_is_taken_out(tmp_path: Path) -> None:
    b = scene()
    draco = {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}
    b.content["meshes"][0]["primitives"][0]["extensions"] = draco | {"other": {}}
    file = read_mesh_file(in_file(tmp_path, b.glb(), "a.glb"))
    write_mesh_file(tmp_path / "out.glb", file, some_uv(len(file.triangulation.triangles)))
    (after, _) = content_of((tmp_path / "out.glb").read_bytes())
    assert after["meshes"][0]["primitives"][0]["extensions"] == {"other": {}}


def test_a_mesh_without_triangles_is_no_gltf(tmp_path: Path) -> None:
    file = read_mesh_file(in_file(tmp_path, b"v 0 0 0\n", "in.obj"))
    with pytest.raises(InputError) as caught:
        write_mesh_file(tmp_path / "out.glb", file, np.empty((0, 3, 2)))
    assert caught.value.code == "EMPTY_MESH"


def test_numbers_beyond_single_precision_are_no_gltf(tmp_path: Path, lsgp) -> None:
    (tmp_path / "in.obj").write_text("v 0 0 0\nv 1e39 0 0\nv 0 1e39 0\nf 1 2 3\n")
    done = lsgp("unwrap", "in.obj", "-o", "out.gltf")
    assert done.code == 3 and not (tmp_path / "out.gltf").exists()


def test_trimesh_reads_what_is_written(tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    file = read_mesh_file(in_file(tmp_path, scene().glb(), "a.glb"))
    uv = some_uv(len(file.triangulation.triangles))
    write_mesh_file(tmp_path / "out.glb", file, uv)
    loaded = trimesh.load(tmp_path / "out.glb", process=False)
    faces = [mesh.faces for mesh in loaded.geometry.values() if isinstance(mesh, trimesh.Trimesh)]
    assert sum(map(len, faces)) == len(uv)
