"""Starts a node of this package as a child of the test, to see how it ends or to kill it."""
import os
import resource
import signal
import subprocess

import roslib.packages


class NodeProcess:
    def __init__(self, node, *arguments, **limits):
        """`max_file_bytes`: no file of the node may grow beyond, as on a full disk."""
        path = roslib.packages.find_node("object_modelling", node)[0]
        max_file_bytes = limits.get("max_file_bytes")

        def limit():
            if max_file_bytes:
                resource.setrlimit(resource.RLIMIT_FSIZE, (max_file_bytes, max_file_bytes))

        # Python ignores SIGXFSZ; not restoring it turns a write beyond the limit into an error.
        self._process = subprocess.Popen([path] + list(arguments), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                         env=dict(os.environ, ROSCONSOLE_STDOUT_LINE_BUFFERED="1"), preexec_fn=limit,
                                         restore_signals=False)

    def wait(self, timeout_s=30):
        """Exit code and everything that was printed."""
        try:
            output, _ = self._process.communicate(timeout=timeout_s)
        except subprocess.TimeoutExpired:
            self.kill()
            raise
        return self._process.returncode, output.decode()

    def running(self):
        return self._process.poll() is None

    def interrupt(self, timeout_s=15):
        self._process.send_signal(signal.SIGINT)
        return self.wait(timeout_s)

    def kill(self):
        self._process.kill()
        self._process.communicate()
