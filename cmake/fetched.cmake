# Libraries that Debian 11 and Ubuntu 20.04 have no fitting package of: the sources that Debian 12 packages, fetched while
# configuring. Without network: unpack the archive anywhere and configure with -DFETCHCONTENT_SOURCE_DIR_<NAME>=<folder>,
# name in capitals.
include(FetchContent)

# object_modelling_fetch(<name> <path in Debian's pool> <SHA256>): sets <name>_SOURCE_DIR.
function(object_modelling_fetch name path sha256)
  set(_url http://deb.debian.org/debian/pool/main/${path})
  string(TOUPPER ${name} _upper)
  message(STATUS "No package serves for ${name}: taking ${_url}, or FETCHCONTENT_SOURCE_DIR_${_upper}")
  FetchContent_Declare(${name} URL ${_url} URL_HASH SHA256=${sha256})
  FetchContent_GetProperties(${name})
  if(NOT ${name}_POPULATED)
    FetchContent_Populate(${name})
  endif()
  set(${name}_SOURCE_DIR ${${name}_SOURCE_DIR} PARENT_SCOPE)
endfunction()

# Headers only.
function(object_modelling_fetch_cli11)
  object_modelling_fetch(cli11 c/cli11/cli11_2.1.2+ds.orig.tar.xz
    8143d20b688e98ccce8e24562d3b68e5f47c12e896c42c7ca8553dbde5bed55d)
  set(CLI11_INCLUDE_DIR ${cli11_SOURCE_DIR}/include PARENT_SCOPE)
endfunction()

# Of OpenMesh only what decimation needs: no file formats.
function(object_modelling_fetch_openmesh)
  object_modelling_fetch(openmesh o/openmesh/openmesh_9.0.orig.tar.gz
    4df84295f5cca86b1ae8bfee8ff4db5efb6850e4e5b571ad0199147176dea796)
  set(_source ${openmesh_SOURCE_DIR}/src)
  set(_core ${_source}/OpenMesh/Core)
  add_library(object_modelling_fetched_openmesh STATIC
    ${_core}/Mesh/ArrayKernel.cc ${_core}/Mesh/BaseKernel.cc ${_core}/Mesh/PolyConnectivity.cc ${_core}/Mesh/TriConnectivity.cc
    ${_core}/System/omstream.cc ${_core}/Utils/BaseProperty.cc ${_source}/OpenMesh/Tools/Decimater/Observer.cc)
  target_include_directories(object_modelling_fetched_openmesh SYSTEM PUBLIC ${_source})
  set_target_properties(object_modelling_fetched_openmesh PROPERTIES POSITION_INDEPENDENT_CODE ON)
  set(OPENMESH_INCLUDE_DIR ${_source} PARENT_SCOPE)
  set(OPENMESH_LIBRARIES object_modelling_fetched_openmesh PARENT_SCOPE)
endfunction()

# Static and hidden, for a process that has libqhull as well.
function(object_modelling_fetch_qhull)
  object_modelling_fetch(qhull q/qhull/qhull_2020.2.orig.tar.gz
    b5c2d7eb833278881b952c8a52d20179eab87766b00b865000469a45c1838b7e)
  set(_source ${qhull_SOURCE_DIR}/src)
  file(GLOB _files ${_source}/libqhull_r/*.c)
  add_library(object_modelling_fetched_qhull STATIC ${_files})
  target_include_directories(object_modelling_fetched_qhull PRIVATE ${_source})
  set_target_properties(object_modelling_fetched_qhull PROPERTIES POSITION_INDEPENDENT_CODE ON C_VISIBILITY_PRESET hidden)
  set(OBJECT_MODELLING_QHULL_INCLUDE_DIR ${_source} PARENT_SCOPE)
  set(OBJECT_MODELLING_QHULL_LIBRARY object_modelling_fetched_qhull PARENT_SCOPE)
endfunction()
