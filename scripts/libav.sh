# FFmpeg's libraries reduced to reading video files, under the LGPL. Sourced by build_wheel.sh.

libav_decoders="av1,cinepak,dnxhd,dvvideo,ffv1,ffvhuff,flv,gif,h263,h264,hevc,huffyuv,jpeg2000,jpegls,lagarith,magicyuv
  mjpeg,mjpegb,mpeg1video,mpeg2video,mpeg4,msmpeg4v1,msmpeg4v2,msmpeg4v3,png,prores,qtrle,rawvideo,theora,tiff,utvideo
  v210,v210x,v410,vc1,vp8,vp9,wmv1,wmv2,wmv3,y41p,yuv4,zlib"
libav_demuxers="asf,avi,dv,flv,gif,h264,hevc,ivf,m4v,matroska,mjpeg,mov,mpegps,mpegts,mpegvideo,mxf,nut,obu,ogg,rawvideo
  vc1,yuv4mpegpipe"
libav_parsers="av1,dnxhd,gif,h263,h264,hevc,jpeg2000,mjpeg,mpeg4video,mpegvideo,png,vc1,vp8,vp9"

# fetch_libav_source SOURCE: the version of this Debian, as a patched source tree. The lists of source packages go to a
# folder beside it, so that the system's configuration stays as it is.
fetch_libav_source() {
  local download="$1.download"
  rm -rf "$download"
  mkdir -p "$download/lists/partial" "$download/source"
  sed 's/^Types: .*/Types: deb-src/' /etc/apt/sources.list.d/debian.sources >"$download/source.sources"
  local apt=(apt-get -q -o Dir::Etc::SourceParts=/dev/null -o "Dir::Etc::SourceList=$download/source.sources"
    -o "Dir::State::Lists=$download/lists" -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache=
    -o APT::Sandbox::User=)
  "${apt[@]}" update
  (cd "$download/source" && "${apt[@]}" source ffmpeg)
  mv "$download"/source/ffmpeg-*/ "$1"
}

# build_libav PREFIX SOURCE
build_libav() {
  [ -x "$2/configure" ] || fetch_libav_source "$2"
  (
    cd "$2"
    ./configure --prefix="$1" --enable-shared --disable-static --disable-everything --disable-autodetect \
      --disable-programs --disable-doc --disable-debug --disable-network --disable-avdevice --disable-avfilter \
      --disable-swresample --enable-zlib --enable-protocol=file --enable-decoder="$(comma_list $libav_decoders)" \
      --enable-demuxer="$(comma_list $libav_demuxers)" --enable-parser="$(comma_list $libav_parsers)"
    make -j"$(nproc)" install
  ) >"$2.log" 2>&1 || { tail -n 20 "$2.log" >&2; return 1; }
}

# comma_list WORD...: with commas between them.
comma_list() {
  local IFS=,
  echo "$*"
}
