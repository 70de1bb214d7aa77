# Environment of every ctest test, whoever starts ctest: scripts run by "#!/usr/bin/env python3" (rostest has some) must
# meet the distribution's Python, no name resolution is needed, logs stay in the build folder.
get_filename_component(_python_folder ${PYTHON_EXECUTABLE} DIRECTORY)
set(_file ${CMAKE_BINARY_DIR}/test_environment.cmake)
file(WRITE ${_file} "\
set(ENV{PATH} \"${_python_folder}:\$ENV{PATH}\")
set(ENV{ROS_HOSTNAME} localhost)
set(ENV{ROS_HOME} \"${CMAKE_BINARY_DIR}/ros_home\")
set(ENV{PYTHONDONTWRITEBYTECODE} 1)
")
if(OBJECT_MODELLING_SANITIZE)
  # OpenNI2 (linked by PCL) leaks in drivers that it has unloaded, so leaks cannot be told apart there.
  file(APPEND ${_file} "\
set(ENV{ASAN_OPTIONS} \"detect_leaks=0:log_path=${CMAKE_BINARY_DIR}/sanitizer_reports/asan\")
set(ENV{UBSAN_OPTIONS} \"print_stacktrace=1:halt_on_error=1:log_path=${CMAKE_BINARY_DIR}/sanitizer_reports/ubsan\")
")
endif()
set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY TEST_INCLUDE_FILES ${_file})
