#pragma once

/// Names of topics and services that more than one node spells; relative, so that they follow namespace and remapping.
namespace object_modelling::ros_bridge::names
{
constexpr char COLOR[] = "rgb/image_rect_color";
constexpr char DEPTH[] = "depth_registered/image_rect";
constexpr char CAMERA_INFO[] = "rgb/camera_info";
constexpr char OBJECT_MASK[] = "object_mask";

constexpr char CAMERA_TRACKER[] = "camera_tracker";
constexpr char STATE[] = "state";
constexpr char KEYFRAME[] = "keyframe";
constexpr char MASK[] = "mask";

constexpr char START[] = "start";
constexpr char STOP[] = "stop";
constexpr char RESET[] = "reset";

constexpr char CREATE_SESSION[] = "create_session";
constexpr char LIST_SESSIONS[] = "list_sessions";
constexpr char GET_SESSION[] = "get_session";
constexpr char UPDATE_SESSION[] = "update_session";
constexpr char SET_SESSION_POSE[] = "set_session_pose";
constexpr char DELETE_SESSION[] = "delete_session";
constexpr char ADD_KEYFRAME[] = "add_keyframe";
constexpr char GET_KEYFRAME[] = "get_keyframe";
constexpr char GET_ENCODED_KEYFRAME[] = "get_encoded_keyframe";
constexpr char CHANGE_SESSION[] = "change_session";
constexpr char UPDATE_POSES[] = "update_poses";
constexpr char UPDATE_MASKS[] = "update_masks";
constexpr char GET_ALIGNMENTS[] = "get_alignments";
constexpr char UPDATE_ALIGNMENTS[] = "update_alignments";
constexpr char EXPORT_SESSION[] = "export_session";
constexpr char IMPORT_SESSION[] = "import_session";

}  // namespace object_modelling::ros_bridge::names
