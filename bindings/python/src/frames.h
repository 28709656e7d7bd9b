// SPDX-License-Identifier: BSD-3-Clause
// Ends of a session's frames and commands: handles that can be closed before Python forgets them.
#pragma once
#include <memory>

#include "chapters.h"
#include "nanotouch/advanced/observer.h"

template <class T, void (*close_handle)(T *)> struct End {
    T *handle = nullptr;
    End() = default;
    End(const End &) = delete;
    ~End()
    {
        close();
    }
    void close()
    {
        close_handle(handle);
        handle = nullptr;
    }
    T *open() const
    {
        if (!handle)
            raise_on(NT_E_STATE, "it is closed");
        return handle;
    }
};

using Frames = End<nt_frames, nt_frames_close>;
using Observer = End<nt_observer, nt_observer_close>;
using Client = End<nt_client, nt_client_close>;
