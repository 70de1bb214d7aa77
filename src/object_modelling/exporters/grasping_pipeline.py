"""Models of TU Wien's grasping_pipeline: STL in mm, models_metadata.yml in m."""
import os

import yaml

from object_modelling import database, mesh_files
from object_modelling.exporters import files

SHARED = True
KEPT = ()
METADATA = "models_metadata.yml"


def export(model, folder):
    files.write(os.path.join(folder, model.id + ".stl"), mesh_files.stl(model.mesh().scaled(1000)))
    path = os.path.join(folder, METADATA)
    metadata = database.load_yaml(path) if os.path.isfile(path) else {}
    metadata[model.id] = {"center": model.model_from_box[:3, 3].tolist(), "extent": model.size_m.tolist(),
                          "rot": model.model_from_box[:3, :3].tolist()}
    files.write(path, yaml.safe_dump(metadata, default_flow_style=False))
