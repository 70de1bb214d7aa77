"""Folders that appear whole or not at all."""
import contextlib
import ctypes
import errno
import fcntl
import os
import shutil
import tempfile

from object_modelling.outcome import Code, Failure

PREFIX = ".object_modelling-export-"
MARKER = "export.yaml"  # by which a folder is known as one of ours
AT_FDCWD, RENAME_EXCHANGE = -100, 2


def storage_failure(path, error):
    return Failure(Code.STORAGE, "%s cannot be written: %s; see that the folder is writable and the disk has space, or "
                   "name another folder" % (path, error.strerror or error))


def write(path, data):
    """A new file; what had the name before may have other names, which keep it."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    if os.path.lexists(path):
        os.remove(path)
    with open(path, "xb") as file:
        file.write(data if isinstance(data, bytes) else data.encode())


def copy(source, path):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    shutil.copyfile(source, path)


class StagedFolder:
    """A hidden folder beside `target`, which takes its place in commit(). Use as a context: left without commit(), it
    and the parents made for it vanish. Raises Failure."""

    def __init__(self, target):
        self.target = os.path.abspath(target)
        self.parent = os.path.dirname(self.target)
        self.path = None
        self._made, self._lock = [], None

    def __enter__(self):
        try:
            self._check_target()
            self._make_parents()
            with _locked(self.parent):
                self._remove_abandoned()
                self.path = tempfile.mkdtemp(prefix=PREFIX, dir=self.parent)
                self._lock = os.open(self.path, os.O_RDONLY)
                fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            os.chmod(self.path, 0o755)
        except BaseException as error:
            self._discard()
            if isinstance(error, OSError):
                raise storage_failure(self.parent, error) from error
            raise
        return self

    def __exit__(self, kind, error, trace):
        self._discard()

    def keep(self, name):
        """Takes over a file or folder of the target, without copying its content."""
        source = os.path.join(self.target, name)
        if os.path.isdir(source) and not os.path.islink(source):
            shutil.copytree(source, os.path.join(self.path, name), symlinks=True, copy_function=_link)
        elif os.path.lexists(source):
            _link(source, os.path.join(self.path, name))

    def keep_all(self):
        for name in os.listdir(self.target) if os.path.isdir(self.target) else []:
            self.keep(name)

    def commit(self):
        """In one step; the folder that was there is gone then."""
        try:
            if os.path.isdir(self.target):
                _exchange(self.path, self.target)
            else:
                os.rename(self.path, self.target)
                self.path = None
            self._made = []
        except OSError as error:
            raise storage_failure(self.target, error) from error

    def _check_target(self):
        if not os.path.lexists(self.target):
            return
        if not os.path.isdir(self.target) or os.path.islink(self.target):
            raise Failure(Code.INVALID_ARGUMENT, "'%s' is in the way: it is no folder; move it, or name another "
                          "folder" % self.target)
        if os.listdir(self.target) and not os.path.isfile(os.path.join(self.target, MARKER)):
            raise Failure(Code.INVALID_ARGUMENT, "'%s' holds files that no export has made (it has no %s), and would "
                          "be replaced: move it, or name another folder" % (self.target, MARKER))

    def _make_parents(self):
        missing, folder = [], self.parent
        while not os.path.isdir(folder):
            missing.append(folder)
            folder = os.path.dirname(folder)
        for folder in reversed(missing):
            os.mkdir(folder)
            self._made.append(folder)

    def _remove_abandoned(self):
        """Those of writers that were killed: nobody holds their lock."""
        for name in os.listdir(self.parent):
            if not name.startswith(PREFIX):
                continue
            path = os.path.join(self.parent, name)
            try:
                descriptor = os.open(path, os.O_RDONLY)
            except FileNotFoundError:  # its writer has removed it just now
                continue
            try:
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
                shutil.rmtree(path, ignore_errors=True)
            except BlockingIOError:
                pass
            finally:
                os.close(descriptor)

    def _discard(self):
        if self.path is not None:
            shutil.rmtree(self.path, ignore_errors=True)
            self.path = None
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None
        for folder in reversed(self._made):
            try:
                os.rmdir(folder)
            except OSError:
                break
        self._made = []


@contextlib.contextmanager
def _locked(folder):
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


def _link(source, target):
    """A second name of the file; a copy where the file system knows none."""
    try:
        os.link(source, target, follow_symlinks=False)
    except OSError:
        shutil.copy2(source, target, follow_symlinks=False)


def _exchange(new, old):
    """Each gets the other's name, in one step where the file system can do that."""
    library = ctypes.CDLL(None, use_errno=True)
    if hasattr(library, "renameat2"):
        if library.renameat2(AT_FDCWD, os.fsencode(new), AT_FDCWD, os.fsencode(old), RENAME_EXCHANGE) == 0:
            return
        code = ctypes.get_errno()
        if code not in (errno.EINVAL, errno.ENOSYS, errno.EOPNOTSUPP):
            raise OSError(code, os.strerror(code))
    parked = new + ".old"
    os.rename(old, parked)
    try:
        os.rename(new, old)
    except BaseException:
        os.rename(parked, old)
        raise
    os.rename(parked, new)
