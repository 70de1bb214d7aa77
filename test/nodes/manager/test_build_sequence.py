import collections
import unittest

from object_modelling import build_sequence
from object_modelling.outcome import Code, Failure

Mark = collections.namedtuple("Mark", "by")
UNDONE = Mark("")
Session = collections.namedtuple(
    "Session", "session_id object_id keyframe_count refined segmented", defaults=(UNDONE, UNDONE))


Request = collections.namedtuple("Request", "object_id name replace again require_all")


class FakeJobs:
    """Records what is called; `fails` names the stage that raises."""

    def __init__(self, sessions=(), fails=None):
        self.sessions = list(sessions)
        self.fails = fails
        self.calls = []
        self.notes = ("", "")
        self.left_out = []

    def list_sessions(self):
        return self.sessions

    def session(self, session_id):
        for session in self.sessions:
            if session.session_id == session_id:
                return session
        raise Failure(Code.NOT_FOUND, "session '%s' does not exist" % session_id)

    def _run(self, stage, what, progress, result=None):
        self.calls.append((stage, what))
        progress("step", 1, 2)
        if self.fails == stage:
            raise Failure(Code.NO_RESULT, stage + " failed")
        return result

    def refine(self, ids, progress):
        self._run("refine", tuple(ids), progress)

    def segment(self, session_id, progress):
        self._run("segment", session_id, progress)

    def align(self, ids, require_all, progress):
        self.require_all = require_all
        placed = ["placement of " + name for name in ids if name not in self.left_out]
        return self._run("align", tuple(ids), progress, placed), self.left_out, self.notes[0]

    def build(self, object_id, name, placements, left_out, replace, progress):
        what = (object_id, name, tuple(placements), tuple(left_out), replace)
        return self._run("build", what, progress, "built"), self.notes[1]


class ChooseSessionsTest(unittest.TestCase):
    def setUp(self):
        self.jobs = FakeJobs([Session("a", "mug", 5), Session("b", "mug", 6), Session("c", "", 7), Session("d", "cup", 0)])

    def choose(self, object_id, session_ids=(), last=""):
        return build_sequence.choose_sessions(self.jobs, object_id, list(session_ids), last)

    def failure(self, code, *arguments):
        with self.assertRaises(Failure) as caught:
            self.choose(*arguments)
        self.assertEqual(caught.exception.code, code)
        return caught.exception.message

    def test_named_sessions_in_their_order(self):
        self.assertEqual(self.choose("mug", ["c", "a"]), ["c", "a"])

    def test_all_sessions_of_the_object(self):
        self.assertEqual(self.choose("mug"), ["a", "b"])

    def test_last_session_if_it_names_no_object(self):
        self.assertEqual(self.choose("plate", last="c"), ["c"])

    def test_last_session_of_another_object_is_not_taken(self):
        self.assertIn("stored: a, b, c, d", self.failure(Code.NOT_FOUND, "plate", (), "a"))

    def test_object_without_session(self):
        self.jobs.sessions = []
        self.assertIn("stored: none", self.failure(Code.NOT_FOUND, "plate"))

    def test_unknown_session(self):
        self.assertIn("'x'", self.failure(Code.NOT_FOUND, "mug", ["a", "x"]))

    def test_session_twice(self):
        self.assertIn("twice: a", self.failure(Code.INVALID_ARGUMENT, "mug", ["a", "b", "a"]))

    def test_session_without_keyframes(self):
        self.assertIn("'d'", self.failure(Code.FAILED_PRECONDITION, "cup"))

    def test_object_ids(self):
        for bad in ("", "a/b", ".hidden", "-x", "x" * 65, "mug\n", "m g"):
            self.failure(Code.INVALID_ARGUMENT, bad)


class BuildTest(unittest.TestCase):
    def setUp(self):
        self.new = [Session("a", "mug", 5), Session("b", "mug", 6)]

    def build(self, jobs, progress=lambda stage, step, done, total: None, again=False, require_all=False):
        ticks = iter(range(100))
        request = Request("mug", "Mug", True, again, require_all)
        return build_sequence.build(jobs, request, ["a", "b"], progress, lambda: next(ticks))

    def test_what_was_refined_or_segmented_stays(self):
        jobs = FakeJobs([Session("a", "mug", 5, Mark("both"), Mark("by_hand")), Session("b", "mug", 6, Mark("multi_view_icp"))])
        reports = []
        times = self.build(jobs, lambda *report: reports.append(report))[1]
        self.assertEqual([stage for stage, _ in times], ["refine", "segment", "align", "build"])
        self.assertIn(("refine", "as before: a, b", 0, 0), reports)
        self.assertIn(("segment", "as before: a", 0, 0), reports)
        self.assertEqual(jobs.calls[:2], [("segment", "b"), ("align", ("a", "b"))])

    def test_all_again_on_request(self):
        jobs = FakeJobs([Session("a", "mug", 5, Mark("both"), Mark("by_hand")), Session("b", "mug", 6, Mark("multi_view_icp"))])
        self.build(jobs, again=True)
        self.assertEqual(jobs.calls[:3], [("refine", ("a", "b")), ("segment", "a"), ("segment", "b")])

    def test_order_and_times(self):
        jobs = FakeJobs(self.new)
        built, times, note = self.build(jobs)
        self.assertEqual((built, note), ("built", ""))
        self.assertEqual(times, [("refine", 1), ("segment", 1), ("align", 1), ("build", 1)])
        self.assertEqual(
            jobs.calls,
            [("refine", ("a", "b")), ("segment", "a"), ("segment", "b"), ("align", ("a", "b")),
             ("build", ("mug", "Mug", ("placement of a", "placement of b"), (), True))])

    def test_notes_are_joined(self):
        jobs = FakeJobs(self.new)
        for notes, expected in ((("left out", ""), "left out"), (("left out", "PARTIAL"), "PARTIAL; left out")):
            jobs.notes = notes
            self.assertEqual(self.build(jobs)[2], expected)

    def test_what_is_left_out_reaches_the_builder(self):
        jobs = FakeJobs(self.new)
        jobs.left_out = ["b"]
        self.build(jobs)
        self.assertEqual(jobs.calls[-1], ("build", ("mug", "Mug", ("placement of a",), ("b",), True)))
        self.assertFalse(jobs.require_all)
        self.build(jobs, require_all=True)
        self.assertTrue(jobs.require_all)

    def test_a_build_that_fails_tells_what_was_left_out(self):
        jobs = FakeJobs(self.new, fails="build")
        jobs.left_out, jobs.notes = ["b"], ("left out: b", "")
        with self.assertRaises(Failure) as caught:
            self.build(jobs)
        self.assertEqual(caught.exception.message, "build failed; left out: b")
        self.assertEqual(caught.exception.code, Code.NO_RESULT)

    def test_progress(self):
        reports = []
        self.build(FakeJobs(self.new), lambda *report: reports.append(report))
        self.assertIn(("segment", "2 of 2, step", 1, 2), reports)
        self.assertEqual(reports[0], ("refine", "", 0, 0))

    def test_a_failed_stage_is_the_last(self):
        for stage in ("refine", "segment", "align", "build"):
            jobs = FakeJobs(self.new, fails=stage)
            with self.assertRaises(Failure):
                self.build(jobs)
            self.assertEqual(jobs.calls[-1][0], stage)

    def test_cancel(self):
        def cancel(stage, *_):
            if stage == "align":
                raise Failure(Code.CANCELLED, "cancelled")

        jobs = FakeJobs(self.new)
        with self.assertRaises(Failure):
            self.build(jobs, cancel)
        self.assertNotIn("build", [call[0] for call in jobs.calls])


if __name__ == "__main__":
    unittest.main()
