"""Puts the page together and writes it."""
import argparse
import base64
import os
import struct
import sys
import tempfile

import jinja2
from markupsafe import Markup

from object_modelling.report import object_data, plots
from object_modelling.report.object_data import ObjectData, ReportError

HERE = os.path.dirname(os.path.abspath(__file__))
# Where Debian and Ubuntu keep three.js (libjs-three).
SCRIPT_FOLDERS = ("/usr/share/javascript/three", "/usr/share/nodejs/three")
SCRIPTS = (("build/three.min.js", "three.min.js", "build/three.js"), ("examples/js/controls/OrbitControls.js",),
           ("examples/js/loaders/GLTFLoader.js",))


def _read(path, mode="rb"):
    try:
        with open(path, mode) as file:
            return file.read()
    except OSError as error:
        raise ReportError("%s cannot be read: %s" % (path, error.strerror)) from error


def library_scripts(folders=SCRIPT_FOLDERS):
    """Text of three.js with its orbit controls and glTF loader."""
    texts = []
    for names in SCRIPTS:
        paths = [os.path.join(folder, name) for folder in folders for name in names]
        found = next((path for path in paths if os.path.isfile(path)), None)
        if found is None:
            raise ReportError("three.js has no %s in %s: install libjs-three" % (names[0], " or ".join(folders)))
        texts.append(_read(found, "r").replace("</script", "<\\/script"))
    return "\n;\n".join(texts)


def _data_uri(path):
    return "data:image/png;base64," + base64.b64encode(_read(path)).decode()


def _tiles(path):
    """How many squares stand side by side in a PNG."""
    header = _read(path)[:24]
    width, height = struct.unpack(">II", header[16:24]) if len(header) == 24 else (0, 0)
    if height == 0 or width < 2 * height:
        raise ReportError("%s is no strip of pictures; build the object anew" % path)
    return width // height


def _model_glb(data):
    """In base64; None where the model has no texture."""
    path = data.path("mesh", "textured.glb")
    return base64.b64encode(_read(path)).decode() if os.path.isfile(path) else None


def _safe_svg(svg):
    # matplotlib has escaped what stands in it.
    return Markup(svg) if svg is not None else None


def render(data):
    """The page's text."""
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True,
                                     undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    quality = data.quality
    cameras = [{"position": keyframe.position_m, "colour": plots.COLOURS[keyframe.light]}
               for keyframe in data.keyframes if keyframe.position_m is not None]
    turntable = data.path("turntable.png")
    try:
        return environment.get_template("template.html").render(
            data=data, quality=quality, limits=object_data, colours=plots.COLOURS, cameras=cameras,
            turntable=_data_uri(turntable) if os.path.isfile(turntable) else None,
            turntable_steps=_tiles(turntable) if os.path.isfile(turntable) else 0,
            glb=_model_glb(data),
            library=Markup(library_scripts()), viewer=Markup(_read(os.path.join(HERE, "viewer.js"), "r")),
            plots={"path": _safe_svg(plots.camera_path(data.keyframes, quality["figures"]["size_m"])),
                   "residuals": _safe_svg(plots.residuals(data.keyframes)),
                   "sigma": _safe_svg(plots.sigma_histogram(quality["sigma"])),
                   "coverage": _safe_svg(plots.coverage_map(quality["coverage"])),
                   "times": _safe_svg(plots.stage_times(quality["stage_s"]))})
    except (KeyError, TypeError, jinja2.UndefinedError) as error:
        raise ReportError("%s: quality.yaml lacks %s; build the object anew" % (data.folder, error)) from error


def write(folder, output=None):
    """Writes report.html of an object's folder; it appears whole or not at all. Returns its path."""
    path = output or os.path.join(folder, "report.html")
    text = render(ObjectData(folder))
    parent = os.path.dirname(os.path.abspath(path))
    temporary = None
    try:
        with tempfile.NamedTemporaryFile("w", encoding="utf-8", dir=parent, prefix=".report-", delete=False) as file:
            temporary = file.name
            file.write(text)
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except OSError as error:
        if temporary and os.path.exists(temporary):
            os.remove(temporary)
        raise ReportError("%s cannot be written: %s" % (path, error.strerror)) from error
    return path


def main(arguments):
    parser = argparse.ArgumentParser(
        prog="object_report", description="Makes report.html in the folder of an object that was built; in a database "
        "use 'object_modelling report', which keeps the hashes right.")
    parser.add_argument("folder", help="folder with object.yaml and quality.yaml")
    parser.add_argument("--output", help="file to write instead of report.html in that folder")
    options = parser.parse_args(arguments)
    try:
        print(write(options.folder, options.output))
    except ReportError as error:
        print("object_report: %s" % error, file=sys.stderr)
        return 1
    return 0
