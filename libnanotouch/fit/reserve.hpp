// SPDX-License-Identifier: BSD-3-Clause
// Memory put by for Ceres; private to fit/. Why, and what it asks of a program:
// docs/decisions/0009-memory-for-ceres.md.
#pragma once

namespace nanotouch
{

// Ceres allocates in destructors (its timings), where std::bad_alloc would end the process, and loses a block where it
// comes between new and the owner. While a reserve lives, operator new of this thread finds it when the heap is
// exhausted: once; what it was needed for is to be given up then (is_used).
class Reserve
{
  public:
    Reserve();
    ~Reserve();
    Reserve(const Reserve &) = delete;
    Reserve &operator=(const Reserve &) = delete;
    static bool is_used();

  private:
    static void give();

    void *memory_;         // null once it is used
    Reserve *const outer_; // of a fit whose law fits
};

} // namespace nanotouch
