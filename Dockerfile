# SPDX-License-Identifier: BSD-3-Clause
# The nanotouch command, without a window: docker build -t nanotouch . && docker run --rm -v "$PWD:/data" nanotouch touch
FROM debian:12-slim AS build
RUN apt-get update && apt-get install -y --no-install-recommends \
    g++ cmake ninja-build make python3-dev python3-venv libceres-dev libeigen3-dev && rm -rf /var/lib/apt/lists/*
COPY . /src
RUN python3 -m venv /opt/nanotouch && /opt/nanotouch/bin/pip install --no-cache-dir '/src[images,curves,record,view,app,maps]'

FROM debian:12-slim
RUN apt-get update && apt-get install -y --no-install-recommends \
    python3 libceres3 libegl1 libgl1-mesa-dri && rm -rf /var/lib/apt/lists/*
COPY --from=build /opt/nanotouch /opt/nanotouch
RUN useradd --create-home nanotouch && mkdir /data && chown nanotouch /data
USER nanotouch
WORKDIR /data
ENV PATH=/opt/nanotouch/bin:$PATH
ENTRYPOINT ["nanotouch"]
