// SPDX-License-Identifier: BSD-3-Clause
// The new handler is the process's: it is ours while any thread has a reserve, and hands on what is not for us.
#include "reserve.hpp"

#include <atomic>
#include <cstdlib>
#include <mutex>
#include <new>

namespace nanotouch
{

namespace
{

constexpr std::size_t size = 65536; // byte; to record its timings and unwind, Ceres takes some hundred

thread_local Reserve *current = nullptr;

std::mutex change;
long users = 0;
std::atomic<std::new_handler> before{nullptr};

} // namespace

void Reserve::give()
{
    if (current && current->memory_) {
        std::free(current->memory_);
        current->memory_ = nullptr;
    } else if (const std::new_handler other = before) {
        other();
    } else {
        throw std::bad_alloc();
    }
}

Reserve::Reserve() : memory_(std::malloc(size)), outer_(current)
{
    if (!memory_)
        throw std::bad_alloc();
    const std::lock_guard<std::mutex> lock(change);
    if (users++ == 0) {
        const std::new_handler found = std::set_new_handler(give);
        if (found != give) // a program that kept ours may have set it again
            before = found;
    }
    current = this;
}

Reserve::~Reserve()
{
    {
        const std::lock_guard<std::mutex> lock(change);
        if (--users == 0 && std::get_new_handler() == give)
            std::set_new_handler(before);
    }
    std::free(memory_);
    current = outer_;
}

bool Reserve::is_used()
{
    return current && !current->memory_;
}

} // namespace nanotouch
