install(DIRECTORY include/${PROJECT_NAME}/ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION})
install(DIRECTORY launch config rviz DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
catkin_install_python(PROGRAMS scripts/demo scripts/export_objects scripts/exporter scripts/object_report
  scripts/recognition_adapter scripts/recognition_demo
  DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
