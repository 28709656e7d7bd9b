// SPDX-License-Identifier: BSD-3-Clause
// The new handler is the process's: it is ours while any thread has a reserve, and hands on what is not for us.
#include "reserve.hpp"

#include <atomic>
#include <cstdlib>
#include <mutex>

namespace nanotouch
{

namespace
{

constexpr std::size_t size = 65536; // byte; to record its timings and unwind, Ceres takes some hundred

thread_local void *reserve = nullptr;
thread_local bool used = false;

std::mutex change;
long users = 0;
std::atomic<std::new_handler> before{nullptr};

void give_reserve()
{
    if (reserve) {
        std::free(reserve);
        reserve = nullptr;
        used = true;
    } else if (const std::new_handler other = before) {
        other();
    } else {
        throw std::bad_alloc();
    }
}

} // namespace

Reserve::Reserve() : outer_(reserve)
{
    void *made = std::malloc(size);
    if (!made)
        throw std::bad_alloc();
    reserve = made;
    const std::lock_guard<std::mutex> lock(change);
    if (users++ == 0)
        before = std::set_new_handler(give_reserve);
}

Reserve::~Reserve()
{
    {
        const std::lock_guard<std::mutex> lock(change);
        if (--users == 0 && std::get_new_handler() == give_reserve)
            std::set_new_handler(before);
    }
    std::free(reserve);
    reserve = outer_;
    used = false;
}

bool Reserve::is_used()
{
    return used;
}

} // namespace nanotouch
