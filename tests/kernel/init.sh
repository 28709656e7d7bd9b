#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# First program of the test kernel (run.sh): the host's files are its root, read only.  PROGRAM ends with a power off.
export PATH=/usr/sbin:/usr/bin:/sbin:/bin
mount -t proc proc /proc
mount -t sysfs sysfs /sys
mount -t devtmpfs devtmpfs /dev
mount -t configfs configfs /sys/kernel/config
if [ -n "${FOLDER:-}" ]; then # of a command, which writes there; it needs memory to share and a place for its own
  mount -t hostfs -o "$FOLDER" none "$FOLDER"
  mkdir /dev/shm
  mount -t tmpfs tmpfs /dev/shm
  export HOME=/dev/shm TMPDIR=/dev/shm MPLCONFIGDIR=/dev/shm
fi
exec "$PROGRAM"
