# QuadEdge, the program and the Python package, in a Debian 12 container.
#   docker build -t quadedge .
#   docker run --rm -v "$PWD:/results" quadedge                                             tracks the built-in sequence
#   docker run --rm -v "$PWD:/results" -v /data/06:/data:ro quadedge run /data -o 06         tracks a recorded one
#   docker run --rm -it --entrypoint python quadedge                                         Python with the package
# Both commands of the README run in the stage that has the source:
#   docker build -t quadedge-source --target source .
#   docker run --rm quadedge-source scripts/run.sh
#   docker run --rm quadedge-source scripts/test.sh
# A GPU needs the OpenCL library of its driver in the container; for NVIDIA:
#   docker run --rm --gpus all -e NVIDIA_DRIVER_CAPABILITIES=compute,utility quadedge devices

FROM debian:12 AS source
WORKDIR /quadedge
# Packages first: they are installed again only when their list changes. git knows the commit.
COPY scripts/packages.sh scripts/
RUN bash -ec '. scripts/packages.sh; install_missing $build_packages $python_packages ca-certificates git' \
  && rm -rf /var/lib/apt/lists/*
COPY . .
CMD ["scripts/run.sh"]

FROM source AS build
RUN scripts/build_wheel.sh /wheels

FROM debian:12-slim
COPY --from=build /wheels /wheels
RUN apt-get update \
  && apt-get install -y --no-install-recommends python3-venv pocl-opencl-icd ocl-icd-libopencl1 ffmpeg \
  && rm -rf /var/lib/apt/lists/* && python3 -m venv /opt/quadedge \
  && /opt/quadedge/bin/pip install --no-cache-dir "$(ls /wheels/*.whl)[bag,batch]" && rm -r /wheels
ENV PATH=/opt/quadedge/bin:$PATH
WORKDIR /results
ENTRYPOINT ["quadedge"]
CMD ["demo"]
