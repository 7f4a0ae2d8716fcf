# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# The command `oort`, without ROS. Recordings and results are in a folder of the host:
#   docker build -t oort . && docker run --rm -v "$PWD:/data" oort replay drive.bag
FROM debian:bookworm AS build
RUN apt-get update && apt-get install -y --no-install-recommends g++ cmake ninja-build python3-dev python3-venv \
    libceres-dev libeigen3-dev capnproto libcapnp-dev
COPY . /oort
RUN /oort/scripts/wheel.sh

FROM debian:bookworm-slim
RUN apt-get update && apt-get install -y --no-install-recommends python3-venv && rm -rf /var/lib/apt/lists/*
RUN --mount=type=bind,from=build,source=/oort/dist,target=/wheels \
    python3 -m venv /opt/oort && /opt/oort/bin/pip install --no-cache-dir /wheels/*.whl
WORKDIR /data
ENTRYPOINT ["/opt/oort/bin/oort"]
