"""What export_objects and the node exporter do: checks, staging, all objects or none."""
import argparse
import contextlib
import hashlib
import json
import os
import signal
import sys

import yaml

from object_modelling import database, exporters
from object_modelling.exporters import files
from object_modelling.outcome import Code, Failure

FIRST_STATUS_EXIT_CODE = 10  # with Code.OK; the others follow in their order. 2 is wrong usage.


def describe(name):
    """The first line of a format's documentation."""
    return exporters.FORMATS[name].__doc__.split("\n")[0].rstrip(".")


def formats_text():
    return "".join("%-18s %s\n" % (name, describe(name)) for name in exporters.FORMATS)


def export_objects(database_path, object_ids, format_name, out="", unit=""):
    """(folder, notes). Exports all objects where none is named. Raises Failure: what was there has stayed then."""
    module = _module(format_name, unit)
    objects = database.Database(database_path)
    ids = sorted(set(object_ids)) or objects.object_ids()
    if not ids:
        raise Failure(Code.FAILED_PRECONDITION, "database '%s' has no objects: build one first (object_modelling "
                      "model, or build_object)" % objects.root)
    models = [objects.object(object_id) for object_id in ids]
    folder = os.path.abspath(os.path.expanduser(out)) if out else os.path.join(objects.root, "exports", format_name)
    if out and not module_is_shared(module) and os.path.isfile(os.path.join(folder, "manifest.yaml")):
        raise Failure(Code.INVALID_ARGUMENT, "'%s' is an object database: name another folder" % folder)
    try:
        with contextlib.ExitStack() as stack:
            notes = (_export_together if module_is_shared(module) else _export_apart)(
                stack, module, objects, models, folder, {"unit": unit} if unit else {}, not object_ids)
    except OSError as error:
        raise files.storage_failure(error.filename or folder, error) from error
    except (KeyError, TypeError, ValueError) as error:
        raise Failure(Code.BAD_INPUT, "an object of '%s' cannot be exported as '%s': %s: %s; see 'object_modelling "
                      "info', or build it anew" % (objects.root, format_name, type(error).__name__, error)) from error
    return folder, notes


def module_is_shared(module):
    return getattr(module, "SHARED", False)


def _module(format_name, unit):
    if format_name not in exporters.FORMATS:
        raise Failure(Code.INVALID_ARGUMENT, "format '%s' is not known: choose one of %s" % (
            format_name, ", ".join(exporters.FORMATS)))
    module = exporters.FORMATS[format_name]
    units = getattr(module, "UNITS", {})
    if unit and unit not in units:
        raise Failure(Code.INVALID_ARGUMENT, "format '%s' has no unit '%s': %s" % (
            format_name, unit, "choose one of " + ", ".join(units) if units else "its unit is fixed, leave it out"))
    return module


def _export_apart(stack, module, objects, models, folder, choices, _):
    """Each object into a folder of its own."""
    staged, notes = [], []
    for model in models:
        target = stack.enter_context(files.StagedFolder(os.path.join(folder, model.id)))
        notes += _export_one(module, objects, model, target, choices)
        _mark(target, module, {}, {model.id: objects.content_hash(model.id)}, choices)
        staged.append(target)
    for target in staged:
        target.commit()
    return notes


def _export_together(stack, module, objects, models, folder, choices, all_of_them):
    """Into one folder, beside those that were exported before; `all_of_them`: these alone."""
    target, notes = stack.enter_context(files.StagedFolder(folder)), []
    marked = {}
    if all_of_them:
        for name in module.KEPT:
            target.keep(name)
    else:
        target.keep_all()
        path = os.path.join(target.path, files.MARKER)
        marked = database.load_yaml(path)["objects"] if os.path.isfile(path) else {}
    for model in models:
        notes += _export_one(module, objects, model, target, choices)
    _mark(target, module, marked, {model.id: objects.content_hash(model.id) for model in models}, choices)
    target.commit()
    return notes


def _export_one(module, objects, model, target, choices):
    notes = module.export(model, target.path, **choices)
    path = model.path("object.yaml")
    with open(path, "rb") as file:
        unchanged = hashlib.sha256(file.read()).hexdigest() == objects.content_hash(model.id)
    if not unchanged:
        raise Failure(Code.FAILED_PRECONDITION, "%s is not the one that manifest.yaml lists: it was built anew meanwhile, "
                      "or changed by hand; export again, or see 'object_modelling info %s'" % (path, objects.root))
    return notes or []


def _mark(target, module, before, hashes, choices):
    """Which objects the folder holds, in which state; and that it is ours to replace."""
    content = dict({"format": module.__name__.rsplit(".", 1)[-1], "objects": dict(before, **hashes)}, **choices)
    files.write(os.path.join(target.path, files.MARKER), yaml.safe_dump(content))


def _parse(arguments):
    parser = argparse.ArgumentParser(
        prog="export_objects", description="Writes objects of a database as files for other programs.",
        epilog="formats:\n" + formats_text(), formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("database", help="folder of the object database")
    parser.add_argument("--format", required=True, help="one of those below; 'list' prints them")
    parser.add_argument("--id", action="append", default=[],
                        help="an object's id, several times for several; all without it")
    parser.add_argument("--out", default="", help="folder to write to instead of DATABASE/exports/FORMAT")
    parser.add_argument("--unit", default="", help="of mesh formats: m (default) or mm")
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    return parser.parse_args(arguments)


def _interrupt(*_):
    """Once: what follows tidies up undisturbed."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    raise KeyboardInterrupt


def main(arguments):
    options = _parse(arguments)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _interrupt)
    if options.format == "list":
        result = {"text": formats_text(), "formats": {name: describe(name) for name in exporters.FORMATS}}
    else:
        try:
            folder, notes = export_objects(options.database, options.id, options.format, options.out, options.unit)
        except Failure as failure:
            print("export_objects: %s" % failure.message.replace("\n", " "), file=sys.stderr)
            return FIRST_STATUS_EXIT_CODE + failure.code
        except KeyboardInterrupt:
            print("export_objects: cancelled; what was there before has stayed", file=sys.stderr)
            return FIRST_STATUS_EXIT_CODE + Code.CANCELLED
        result = {"text": folder + "\n", "folder": folder, "warning": "; ".join(notes)}
    if options.json:
        print(json.dumps(result))
    else:
        print(result["text"], end="")
        if result.get("warning"):
            print("export_objects: WARNING: " + result["warning"], file=sys.stderr)
    return 0
