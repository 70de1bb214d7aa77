"""Every order of calls and tracker reports that a user can produce, without ROS."""
import unittest

from object_modelling.modelling_state import ModellingState, State
from object_modelling.outcome import Code, Failure


class ModellingStateTest(unittest.TestCase):
    def setUp(self):
        self.state = ModellingState()

    def refused(self, text, call, *arguments):
        with self.assertRaises(Failure) as caught:
            call(*arguments)
        self.assertEqual(caught.exception.code, Code.FAILED_PRECONDITION)
        self.assertIn(text, caught.exception.message)

    def test_stop_before_start(self):
        self.refused("none has been recorded yet", self.state.check_can_stop)

    def test_stop_twice_names_the_last_session(self):
        self.state.started("s1")
        self.state.check_can_stop()
        self.state.stopped(7)
        self.assertEqual(self.state.keyframe_count, 7)
        self.refused("'s1'", self.state.check_can_stop)

    def test_start_twice(self):
        self.state.check_can_start()
        self.state.started("s1")
        self.refused("session 's1' is being recorded", self.state.check_can_start)

    def test_build_while_recording(self):
        self.state.started("s1")
        self.refused("stop_session before building 'mug'", self.state.begin_build, "mug")

    def test_everything_but_cancel_is_refused_while_building(self):
        self.state.begin_build("mug")
        self.refused("while object 'mug' is being built", self.state.check_can_start)
        self.refused("while object 'mug' is being built", self.state.begin_build, "cup")
        self.refused("while object 'mug' is being built", self.state.session_to_discard, "s1")
        self.refused("no session is being recorded", self.state.check_can_stop)
        self.assertEqual(self.state.request_cancel(), "mug")
        self.assertTrue(self.state.cancel_requested)

    def test_cancel_without_build(self):
        self.refused("nothing to cancel", self.state.request_cancel)
        self.state.started("s1")
        self.refused("discard_session", self.state.request_cancel)

    def test_a_new_build_is_not_cancelled_by_the_cancel_of_the_last(self):
        self.state.begin_build("mug")
        self.state.request_cancel()
        self.state.end_build()
        self.state.begin_build("mug")
        self.assertFalse(self.state.cancel_requested)

    def test_discard(self):
        self.refused("name the session", self.state.session_to_discard, "")
        self.state.started("s1")
        self.assertEqual(self.state.session_to_discard(""), "s1")
        self.assertTrue(self.state.is_recording("s1"))
        self.state.discarded("s1")
        self.assertEqual(self.state.state, State.IDLE)
        self.refused("name the session", self.state.session_to_discard, "")

    def test_discarding_another_session_leaves_the_recording_alone(self):
        self.state.started("s2")
        self.state.discarded("s1")
        self.assertTrue(self.state.is_recording("s2"))


class TrackerReportTest(unittest.TestCase):
    def setUp(self):
        self.state = ModellingState()

    def test_old_report_after_start_is_ignored(self):
        self.state.started("s1")
        self.assertEqual(self.state.tracker_reported(False, "", 0), (False, None))
        self.assertTrue(self.state.is_recording("s1"))

    def test_report_before_the_answer_to_start(self):
        self.state.tracker_reported(True, "s1", 1)
        self.state.started("s1")
        self.assertEqual(self.state.keyframe_count, 1)
        self.assertTrue(self.state.tracker_reported(False, "", 0)[0])

    def test_old_report_after_stop_is_ignored(self):
        self.state.started("s1")
        self.state.tracker_reported(True, "s1", 3)
        self.state.stopped(4)
        self.state.tracker_reported(True, "s1", 4)
        self.assertEqual(self.state.state, State.IDLE)
        self.assertEqual(self.state.tracker_reported(False, "s1", 4), (False, None))
        self.state.tracker_reported(True, "s1", 5)  # somebody resumed it without the manager
        self.assertEqual(self.state.state, State.RECORDING)

    def test_the_end_that_was_asked_for_is_no_surprise(self):
        self.state.started("s1")
        self.state.tracker_reported(True, "s1", 3)
        self.state.ending()
        self.assertEqual(self.state.tracker_reported(False, "s1", 3), (False, None))
        self.state.stopped(3)
        self.assertEqual(self.state.state, State.IDLE)
        self.state.started("s2")
        self.state.tracker_reported(True, "s2", 1)
        self.assertIsNotNone(self.state.tracker_reported(False, "s2", 1)[1])

    def test_keyframes_are_counted(self):
        self.state.started("s1")
        self.assertEqual(self.state.tracker_reported(True, "s1", 2), (True, None))
        self.assertEqual(self.state.tracker_reported(True, "s1", 2), (False, None))
        self.assertEqual(self.state.keyframe_count, 2)

    def test_recording_started_at_the_tracker_can_be_stopped_here(self):
        self.state.tracker_reported(True, "other", 1)
        self.state.check_can_stop()

    def test_tracker_restarted_while_recording(self):
        self.state.started("s1")
        self.state.tracker_reported(True, "s1", 3)
        changed, failure = self.state.tracker_reported(False, "", 0)
        self.assertTrue(changed)
        self.assertIn("'s1'", failure.message)
        self.state.check_can_start()
        self.state.begin_build("mug")

    def test_tracker_gone_and_back(self):
        self.state.started("s1")
        self.state.tracker_reported(True, "s1", 3)
        self.state.tracker_lost()
        self.assertEqual(self.state.state, State.IDLE)
        self.state.tracker_reported(True, "s1", 4)
        self.assertTrue(self.state.is_recording("s1"))

    def test_recording_does_not_end_a_build(self):
        self.state.begin_build("mug")
        self.state.tracker_reported(True, "s9", 1)
        self.assertEqual(self.state.state, State.BUILDING)


if __name__ == "__main__":
    unittest.main()
