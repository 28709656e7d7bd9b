// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>

#include "chapters.h"

// A description with its table of fields: one binding serves scene, rig and settings.
template <class T> struct Described {
    T value;
    std::shared_ptr<void> kept{}; // what the value points to: the functions of a scene's own laws
};
