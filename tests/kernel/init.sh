#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# First program of the test kernel (run.sh): the host's files are its root, read only.  PROGRAM ends with a power off.
export PATH=/usr/sbin:/usr/bin:/sbin:/bin
mount -t proc proc /proc
mount -t sysfs sysfs /sys
mount -t devtmpfs devtmpfs /dev
mount -t configfs configfs /sys/kernel/config
exec "$PROGRAM"
