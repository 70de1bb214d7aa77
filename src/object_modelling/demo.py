"""Drives one session as a user would: start, play a recording, stop, build; and prints the result."""
import argparse
import contextlib
import os
import subprocess
import sys
import threading
import time

import roslib.packages
import rospy

from object_modelling import msg, srv
from object_modelling.outcome import Code, Failure

EXIT_OK, EXIT_FAILED, EXIT_USAGE, EXIT_NODE_DOWN, EXIT_RECORDING, EXIT_TIMEOUT = 0, 1, 2, 3, 4, 5
EPILOG = """exit codes: 0 the object was built, 1 it could not be built, 2 wrong usage, 3 a node is down,
4 the recording could not be played or tracked, 5 --timeout has passed"""


class DemoError(Exception):
    def __init__(self, exit_code, message):
        super().__init__(message)
        self.exit_code = exit_code


def parse(arguments):
    parser = argparse.ArgumentParser(
        prog="demo", description=__doc__, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recording", help="TUM-style folder or ROS bag, played by play_dataset")
    parser.add_argument("--object-id", default="demo_object", help="id of the object in the database (%(default)s)")
    parser.add_argument("--name", default="", help="its name for people")
    parser.add_argument("--session-id", default="", help="id of the session; made from the time if left out")
    parser.add_argument("--rate", type=float, help="speed of the recording, 1 as recorded; left out: every frame, as "
                        "fast as the tracker takes them")
    parser.add_argument("--camera", default="camera", help="namespace to play into (%(default)s)")
    parser.add_argument("--namespace", default="object_modelling", help="namespace of the nodes (%(default)s)")
    parser.add_argument("--timeout", type=float, default=600, help="seconds for all of it (%(default)s)")
    parser.add_argument("--startup-timeout", type=float, default=30, help="seconds for the nodes to come up "
                        "(%(default)s)")
    options = parser.parse_args(arguments)
    if options.timeout <= 0 or options.startup_timeout <= 0 or (options.rate is not None and options.rate <= 0):
        parser.error("--timeout, --startup-timeout and --rate must be greater than 0")
    if not os.path.exists(options.recording):
        parser.error("recording '%s' does not exist" % options.recording)
    return options


class Demo:
    def __init__(self, options, say=print):
        self._options = options
        self._say = say
        self._deadline = time.monotonic() + options.timeout
        self._manager = "/%s/modelling_manager/" % options.namespace.strip("/")
        self._state = msg.ManagerState()
        self._subscriber = None

    def run(self):
        self._wait_for_nodes()
        self._subscriber = rospy.Subscriber(self._manager + "state", msg.ManagerState, self._on_state)
        times = []
        session_id = self._call("start_session", srv.StartSession, session_id=self._options.session_id,
                                object_id=self._options.object_id).session_id
        self._say("recording session '%s'" % session_id)
        started = time.monotonic()
        try:
            self._play()
        except DemoError:
            with contextlib.suppress(rospy.ServiceException):
                rospy.ServiceProxy(self._manager + "stop_session", srv.StopSession)()
            raise
        stopped = self._call("stop_session", srv.StopSession)
        times.append(("track", time.monotonic() - started))
        self._say("  %d frames, %d of them tracked, %d keyframes, %.1f s" % (
            stopped.frame_count, stopped.tracked_count, stopped.keyframe_count, times[0][1]))
        if stopped.keyframe_count == 0:
            raise DemoError(EXIT_RECORDING, "nothing was tracked; ~state of the camera_tracker says why")
        built = self._build(session_id)
        times += [(stage.stage, stage.duration_s) for stage in built.stages]
        self._report(built, times)
        return built

    def _wait_for_nodes(self):
        end = time.monotonic() + self._options.startup_timeout
        root = self._manager.rsplit("/", 2)[0]
        names = ["modelling_manager/build_object", "camera_tracker/start", "keyframe_store/get_keyframe",
                 "segmenter/segment", "model_builder/list_objects"]
        for name in names:
            try:
                rospy.wait_for_service("%s/%s" % (root, name), max(0.1, end - time.monotonic()))
            except rospy.ROSException:
                raise DemoError(EXIT_NODE_DOWN, "service %s/%s is not there after %g s: are the nodes up (roslaunch "
                                "object_modelling object_modelling.launch)?" % (
                                    root, name, self._options.startup_timeout)) from None

    def _on_state(self, state):
        self._state = state

    def _call(self, service, service_type, **fields):
        try:
            answer = rospy.ServiceProxy(self._manager + service, service_type)(**fields)
        except rospy.ServiceException as error:
            raise DemoError(EXIT_NODE_DOWN, "%s%s: %s" % (self._manager, service, error)) from error
        if answer.status.code != Code.OK:
            raise Failure(answer.status.code, "%s: %s" % (service, answer.status.message))
        return answer

    def _play(self):
        player = roslib.packages.find_node("object_modelling", "play_dataset")
        if not player:
            raise DemoError(EXIT_RECORDING, "play_dataset is not built")
        root = self._manager.rsplit("/", 2)[0]
        command = [player[0], self._options.recording, "--wait", str(self._options.startup_timeout)]
        if self._options.rate is None:
            command += ["--lossless", "--tracker-state", root + "/camera_tracker/state"]
        else:
            command += ["--rate", str(self._options.rate)]
        environment = dict(os.environ, ROS_NAMESPACE="/" + self._options.camera.strip("/"))
        process = subprocess.Popen(command, env=environment)
        try:
            code = process.wait(max(0.1, self._deadline - time.monotonic()))
        except subprocess.TimeoutExpired:
            raise self._timed_out("playing the recording") from None
        finally:
            if process.poll() is None:
                process.terminate()
                process.wait()
        if code != 0:
            raise DemoError(EXIT_RECORDING, "play_dataset ended with exit code %d" % code)

    def _build(self, session_id):
        self._say("building '%s'" % self._options.object_id)
        outcome = {}

        def call():
            try:
                # A later demo may replace the object: nothing depends on its frame.
                outcome["built"] = self._call("build_object", srv.BuildObject, object_id=self._options.object_id,
                                              name=self._options.name, session_ids=[session_id], replace=True,
                                              wait=True).built
            except (DemoError, Failure) as error:
                outcome["error"] = error

        builder = threading.Thread(target=call, daemon=True)
        builder.start()
        self._follow(builder)
        if "error" in outcome:
            raise outcome["error"]
        return outcome["built"]

    def _follow(self, builder):
        """One line for each stage that has ended."""
        stage, since = "", time.monotonic()
        while builder.is_alive() or stage:
            current = self._state.stage if builder.is_alive() else ""
            if current != stage:
                if stage:
                    self._say("  %-8s %5.1f s" % (stage, time.monotonic() - since))
                stage, since = current, time.monotonic()
            if time.monotonic() > self._deadline:
                self._call("cancel", srv.Cancel)
                raise self._timed_out("stage '%s'" % stage)
            builder.join(0.05)

    def _timed_out(self, what):
        return DemoError(EXIT_TIMEOUT, "%s took longer than the %g s of --timeout" % (what, self._options.timeout))

    def _report(self, built, times):
        self._say("made '%s': %.0f x %.0f x %.0f mm, diameter %.0f mm, %d points, %d triangles" % (
            built.object_id, 1e3 * built.size_m.x, 1e3 * built.size_m.y, 1e3 * built.size_m.z,
            1e3 * built.diameter_m, built.point_count, built.triangle_count))
        self._say("stages: " + ", ".join("%s %.1f s" % time for time in times))
        self._say("folder:  %s" % built.object_folder)
        self._say("mesh:    %s" % built.mesh_path)
        self._say("preview: %s" % built.preview_path)


def main(arguments):
    options = parse(arguments)
    rospy.init_node("demo", anonymous=True, disable_signals=True)
    try:
        Demo(options, lambda line: print(line, flush=True)).run()
    except DemoError as error:
        print("demo: %s" % error, file=sys.stderr)
        return error.exit_code
    except Failure as failure:
        print("demo: %s" % failure.message, file=sys.stderr)
        return EXIT_NODE_DOWN if failure.code == Code.TIMEOUT else EXIT_FAILED
    except KeyboardInterrupt:
        return EXIT_FAILED
    return EXIT_OK
