# QuadEdge in a Debian 12 container.
#   docker build -t quadedge .
#   docker run --rm -v "$PWD:/results" quadedge                                             tracks the built-in sequence
#   docker run --rm -v "$PWD:/results" -v /data/06:/data:ro quadedge run /data -o 06         tracks a recorded one
# Both commands of the README run in the stage that has the source:
#   docker build -t quadedge-source --target source .
#   docker run --rm quadedge-source scripts/run.sh
#   docker run --rm quadedge-source scripts/test.sh
# A GPU needs the OpenCL library of its driver in the container; for NVIDIA:
#   docker run --rm --gpus all -e NVIDIA_DRIVER_CAPABILITIES=compute,utility quadedge devices

FROM debian:12 AS source
WORKDIR /quadedge
# Packages first: they are installed again only when their list changes. cpack needs file, and git knows the commit.
COPY scripts/packages.sh scripts/
RUN bash -ec '. scripts/packages.sh && install_missing $build_packages ca-certificates file git && rm -rf /var/lib/apt/lists/*'
COPY . .
CMD ["scripts/run.sh"]

FROM source AS build
RUN cmake -S . -B build_package -G Ninja -DCMAKE_BUILD_TYPE=Release -DQUADEDGE_UNITY=ON \
  && cmake --build build_package && cpack --config build_package/CPackConfig.cmake -B /packages

FROM debian:12-slim
COPY --from=build /packages/quadedge_*.deb /tmp/
RUN apt-get update && apt-get install -y --no-install-recommends /tmp/quadedge_*.deb pocl-opencl-icd ffmpeg \
  && rm -rf /var/lib/apt/lists/* /tmp/quadedge_*.deb
WORKDIR /results
ENTRYPOINT ["quadedge"]
CMD ["demo"]
