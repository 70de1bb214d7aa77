"""moveit_msgs/CollisionObject as YAML: of convex meshes, and of the box."""
import os

import numpy as np
import yaml

from object_modelling.exporters import bodies, files

ADD, BOX = 0, 1  # moveit_msgs/CollisionObject, shape_msgs/SolidPrimitive


def export(model, folder):
    parts = [_mesh(mesh) for mesh in bodies.collision_meshes(model)]
    box = {"type": BOX, "dimensions": model.size_m.tolist()}
    for name, shapes in (("collision_object", {"meshes": parts, "mesh_poses": [pose(np.eye(4))] * len(parts)}),
                         ("collision_object_box", {"primitives": [box],
                                                   "primitive_poses": [pose(model.model_from_box)]})):
        message = dict({"primitives": [], "primitive_poses": [], "meshes": [], "mesh_poses": []}, **shapes)
        message.update({"header": {"seq": 0, "stamp": {"secs": 0, "nsecs": 0}, "frame_id": "object_%s_0" % model.id},
                        "id": model.id, "type": {"key": model.id, "db": ""}, "pose": pose(np.eye(4)), "planes": [],
                        "plane_poses": [], "subframe_names": [], "subframe_poses": [], "operation": ADD})
        text = yaml.dump(message, Dumper=_NoAliases, default_flow_style=None, sort_keys=False)
        files.write(os.path.join(folder, name + ".yaml"), text)


class _NoAliases(yaml.SafeDumper):
    """Writes what stands twice twice: readers of messages know no anchors."""

    def ignore_aliases(self, data):
        return True


def pose(frame_from_part):
    """geometry_msgs/Pose"""
    position, (x, y, z, w) = frame_from_part[:3, 3].tolist(), quaternion(frame_from_part[:3, :3])
    return {"position": dict(zip("xyz", position)), "orientation": {"x": x, "y": y, "z": z, "w": w}}


def quaternion(rotation):
    """x, y, z, w; w not negative."""
    symmetric = np.array([[rotation[i, j] + rotation[j, i] for j in range(3)] for i in range(3)])
    trace = np.trace(rotation)
    matrix = np.zeros((4, 4))
    matrix[:3, :3] = symmetric - trace * np.eye(3)
    matrix[3, :3] = matrix[:3, 3] = [rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0],
                                     rotation[1, 0] - rotation[0, 1]]
    matrix[3, 3] = trace
    found = np.linalg.eigh(matrix)[1][:, -1]  # of the largest eigenvalue (Bar-Itzhack 2000)
    return (found if found[3] >= 0 else -found).tolist()


def _mesh(mesh):
    """shape_msgs/Mesh"""
    return {"triangles": [{"vertex_indices": triangle} for triangle in mesh.triangles.tolist()],
            "vertices": [dict(zip("xyz", vertex)) for vertex in mesh.vertices.tolist()]}
