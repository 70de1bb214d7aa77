# Explicit lists: a message that is not listed is not generated.
add_message_files(FILES
  Status.msg Plane.msg SensorNoiseModel.msg SensorCalibration.msg
  Observation.msg Keyframe.msg EncodedKeyframe.msg KeyframePose.msg ObjectMask.msg PoseUpdate.msg StageMark.msg Session.msg SessionChange.msg StoreState.msg TrackingState.msg
  Progress.msg ObjectHypothesis.msg Hypotheses.msg SessionPlacement.msg AlignmentCandidate.msg AlignmentEdge.msg
  AlignmentRecord.msg IcpResidual.msg KeyframeResidual.msg
  KeyframeLink.msg SessionRefinement.msg StageTime.msg ObjectSummary.msg SimilarObject.msg BuiltObject.msg ManagerState.msg
  SessionLeftOut.msg Detection.msg Detections.msg KnownObjects.msg TriangleMesh.msg RestingPose.msg Symmetry.msg
  ObjectModel.msg)
add_service_files(FILES
  StartTracking.srv StopTracking.srv ResetTracking.srv
  CreateSession.srv ListSessions.srv GetSession.srv UpdateSession.srv ChangeSession.srv SetSessionPose.srv DeleteSession.srv
  AddKeyframe.srv GetKeyframe.srv GetEncodedKeyframe.srv UpdatePoses.srv UpdateMasks.srv GetAlignments.srv UpdateAlignments.srv
  ExportSession.srv ImportSession.srv
  Segment.srv SelectHypothesis.srv SetRoi.srv ClearSelection.srv
  AcceptAlignment.srv RefuseAlignment.srv ForgetAlignment.srv AlignByPoints.srv ShowAlignment.srv
  StartSession.srv StopSession.srv DiscardSession.srv BuildObject.srv ListObjects.srv ExportObjects.srv Cancel.srv
  Recognise.srv ReloadDatabase.srv GetObjectModel.srv)
add_action_files(FILES Refine.action SegmentSession.action Align.action Build.action)
generate_messages(DEPENDENCIES actionlib_msgs geometry_msgs sensor_msgs std_msgs)
