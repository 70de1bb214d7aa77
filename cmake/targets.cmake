# Libraries, lowest layer first. README.md, docs/architecture.md and test/architecture read the same order.
set(OBJECT_MODELLING_LIBRARIES
  base geometry mesh rgbd source features registration tracking segmentation calibration keyframes bundle_adjustment
  multi_view_icp fusion surface texture evaluation object_properties alignment database recognition report pipeline)
set(OBJECT_MODELLING_EXPORTED_LIBRARIES)
foreach(_library ${OBJECT_MODELLING_LIBRARIES})
  list(APPEND OBJECT_MODELLING_EXPORTED_LIBRARIES object_modelling_${_library})
endforeach()

function(_object_modelling_compile_options target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual)
  if(OBJECT_MODELLING_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(OBJECT_MODELLING_SANITIZE)
    # GCC warns of optional values without reason once the code is instrumented.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  endif()
endfunction()

# object_modelling_add_library(<library> SOURCES a.cpp ... PUBLIC base opencv ... PRIVATE ceres ...)
# PUBLIC and PRIVATE name our libraries and the third-party targets of third_party.cmake, without prefix.
function(object_modelling_add_library name)
  cmake_parse_arguments(_arg "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(_target object_modelling_${name})
  add_library(${_target} SHARED ${_arg_SOURCES})
  target_include_directories(${_target} PUBLIC ${PROJECT_SOURCE_DIR}/include)
  list(TRANSFORM _arg_PUBLIC PREPEND object_modelling_)
  list(TRANSFORM _arg_PRIVATE PREPEND object_modelling_)
  target_link_libraries(${_target} PUBLIC ${_arg_PUBLIC} PRIVATE ${_arg_PRIVATE})
  _object_modelling_compile_options(${_target})
  object_modelling_build_fast_by_links(${_target} ${_arg_PUBLIC} ${_arg_PRIVATE})
  install(TARGETS ${_target} LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
endfunction()

# object_modelling_add_executable(<name> SOURCES ... LINK base opencv ...); lands in lib/object_modelling, where rosrun looks.
function(object_modelling_add_executable name)
  cmake_parse_arguments(_arg "" "OUTPUT_NAME" "SOURCES;LINK" ${ARGN})
  set(_target object_modelling_${name}_executable)
  add_executable(${_target} ${_arg_SOURCES})
  set_target_properties(${_target} PROPERTIES OUTPUT_NAME ${name}
    RUNTIME_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_BIN_DESTINATION})
  list(TRANSFORM _arg_LINK PREPEND object_modelling_)
  target_link_libraries(${_target} PRIVATE ${_arg_LINK})
  _object_modelling_compile_options(${_target})
  object_modelling_build_fast_by_links(${_target} ${_arg_LINK})
  install(TARGETS ${_target} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  set_property(GLOBAL APPEND PROPERTY OBJECT_MODELLING_PROGRAMS ${_target})
endfunction()

# object_modelling_add_gtest(<library> test_a.cpp ... [LINK more]): one executable test_<library>, linked with the library
# and test/support.
function(object_modelling_add_gtest library)
  cmake_parse_arguments(_arg "" "" "LINK" ${ARGN})
  set(_target test_${library})
  catkin_add_gtest(${_target} ${_arg_UNPARSED_ARGUMENTS} WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
  list(TRANSFORM _arg_LINK PREPEND object_modelling_)
  target_link_libraries(${_target} object_modelling_${library} object_modelling_test_support ${_arg_LINK})
  target_compile_definitions(${_target} PRIVATE OBJECT_MODELLING_TEST_DATA="${PROJECT_SOURCE_DIR}/test/data")
  _object_modelling_compile_options(${_target})
  _object_modelling_links_openmp(_openmp object_modelling_${library} ${_arg_LINK})
  if(NOT _openmp)
    object_modelling_build_fast(${_target} tests)
  endif()
  set_property(GLOBAL APPEND PROPERTY OBJECT_MODELLING_TEST_TARGETS ${_target})
endfunction()
