# The parts of FFmpeg that read videos: find_package(Libav REQUIRED) gives the target Libav::Libav.
find_path(Libav_INCLUDE_DIR libavformat/avformat.h PATH_SUFFIXES ffmpeg)
set(Libav_LIBRARIES "")
set(parts "")
foreach(part avformat avcodec swscale avutil)
  find_library(Libav_${part}_LIBRARY ${part})
  list(APPEND Libav_LIBRARIES ${Libav_${part}_LIBRARY})
  list(APPEND parts Libav_${part}_LIBRARY)
endforeach()
mark_as_advanced(Libav_INCLUDE_DIR ${parts})

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Libav REQUIRED_VARS Libav_INCLUDE_DIR ${parts})
if(Libav_FOUND AND NOT TARGET Libav::Libav)
  add_library(Libav::Libav INTERFACE IMPORTED)
  set_target_properties(Libav::Libav PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${Libav_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES "${Libav_LIBRARIES}")
endif()
unset(parts)
