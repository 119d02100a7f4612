"""Point-to-plane ICP of each frame against the map (Open3D), the tool that most people would take for this.

    python icp.py --map MESH --sequence FOLDER --every 1,2,4,8

prints one JSON object: for each variant and thinning the errors of every frame, all offsets together. A frame starts
from the last one's pose, or from where the last motion would carry it on. Correspondences are gated in stages, wide to
narrow. It is given its start, as the filters are, and it has no word for being lost.
"""

import argparse
import json
import sys

import numpy as np
import open3d as o3d

from course_lib.depth_mcl.evaluation import pose_errors
from course_lib.depth_mcl.sequence import DepthSequence, read_sequence
from course_lib.rendering.scene_map import SceneMap

# The gates are those that served best on the kitchen and on recordings with larger motions.
GATES = {"0.15, 0.05 m": (0.15, 0.05), "0.5, 0.15, 0.05 m": (0.5, 0.15, 0.05)}
MAP_POINTS = 300_000
ITERATIONS = 30
VOXEL = 0.03  # metres: one of the frame's points a voxel; all of them take three times as long (chosen)


def map_cloud(scene_map: SceneMap) -> o3d.geometry.PointCloud:
    """Points with normals, evenly over the map's surface."""
    mesh = o3d.geometry.TriangleMesh(
        o3d.utility.Vector3dVector(scene_map.vertices.copy()), o3d.utility.Vector3iVector(scene_map.faces.copy())
    )
    mesh.compute_triangle_normals()
    o3d.utility.random.seed(0)
    return mesh.sample_points_uniformly(MAP_POINTS, use_triangle_normal=True)


def follow(
    target: o3d.geometry.PointCloud, sequence: DepthSequence, gates: tuple[float, ...], velocity: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Distances (m) and angles (degrees) from the truth, frame by frame."""
    camera, true = sequence.camera(), sequence.camera_to_world
    pose, motion, found = true[0], np.eye(4), []
    estimation = o3d.pipelines.registration.TransformationEstimationPointToPlane()
    criteria = o3d.pipelines.registration.ICPConvergenceCriteria(max_iteration=ITERATIONS)
    for index in range(len(sequence)):
        points = camera.points(sequence.depth(index)).reshape(-1, 3)
        source = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points[np.isfinite(points).all(axis=1)]))
        guess = pose @ motion if velocity else pose
        source = source.voxel_down_sample(VOXEL)
        for gate in gates:
            result = o3d.pipelines.registration.registration_icp(source, target, gate, guess, estimation, criteria)
            guess = result.transformation
        if index:
            motion = np.linalg.inv(pose) @ guess
        pose = guess
        found.append(pose)
    position, rotation = pose_errors(np.array(found), true)
    return position, np.rad2deg(rotation)


def measure(map_file: str, sequence: str, everies: list[int]) -> dict[str, dict[int, dict]]:
    """Errors of every frame, by variant and thinning."""
    target, whole = map_cloud(SceneMap.load(map_file)), read_sequence(sequence)
    rows = {}
    for every in everies:
        for name, gates in GATES.items():
            for velocity in (False, True):
                runs = [follow(target, whole.thinned(every, offset), gates, velocity) for offset in range(every)]
                told = f"ICP {name}{', going on' if velocity else ''}"
                rows.setdefault(told, {})[every] = {
                    "position_m": np.concatenate([p for p, _ in runs]).tolist(),
                    "rotation_deg": np.concatenate([r for _, r in runs]).tolist(),
                }
                print(told, every, file=sys.stderr)
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--map", required=True)
    parser.add_argument("--sequence", required=True)
    parser.add_argument("--every", default="1")
    given = parser.parse_args()
    print(json.dumps(measure(given.map, given.sequence, [int(n) for n in given.every.split(",")])))
