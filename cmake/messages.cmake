# Explicit lists: a message that is not listed is not generated.
add_message_files(FILES Status.msg)
generate_messages(DEPENDENCIES actionlib_msgs geometry_msgs sensor_msgs std_msgs)
