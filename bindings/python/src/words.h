// SPDX-License-Identifier: BSD-3-Clause
// The words of a choice, "no|yes": they stand beside its enum in C, in the order of its numbers
#pragma once
#include <sstream>
#include <string>

inline std::string word_of(const char *words, int number)
{
    std::istringstream list(words);
    std::string word;
    for (; number >= 0; --number)
        if (!std::getline(list, word, '|'))
            return "";
    return word;
}

// -1: none of them
inline int number_of(const char *words, const std::string &word)
{
    std::istringstream list(words);
    std::string other;
    for (int number = 0; std::getline(list, other, '|'); ++number)
        if (other == word)
            return number;
    return -1;
}
