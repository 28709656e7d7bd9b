// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "chapters.h"

// A description with its table of fields: one binding serves scene, rig and settings.
template <class T> struct Described {
    T value;
};
