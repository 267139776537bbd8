// What every fuzzer shares: values out of a fuzzer's bytes, and the way to fail.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <span>
#include <string>
#include <string_view>

extern "C" {
int LLVMFuzzerInitialize(int* argc, char*** argv);
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
}

namespace fuzz {

/// Numbers that code forgets. Those from `kFinite` on are none.
inline constexpr std::array kNumbers = {0.0,
                                        -0.0,
                                        1.0,
                                        -1.0,
                                        0.5,
                                        2.0,
                                        1e-6,
                                        1e-38,
                                        1e-45,
                                        255.0,
                                        65536.,
                                        1e6,
                                        -1e6,
                                        1e9,
                                        2147483647.0,
                                        4294967296.0,
                                        -2147483648.0,
                                        1e18,
                                        1e30,
                                        -1e30,
                                        3.4e38,
                                        -3.4e38,
                                        1e300,
                                        std::numeric_limits<double>::infinity(),
                                        -std::numeric_limits<double>::infinity(),
                                        std::numeric_limits<double>::quiet_NaN()};
inline constexpr std::size_t kFinite = kNumbers.size() - 3;

/// Ends the program, so that the fuzzer keeps the input.
[[noreturn]] inline void fail(std::string_view what) {
    std::fprintf(stderr, "==fuzz== %.*s\n", int(what.size()), what.data());
    std::abort();
}
inline void check(bool holds, std::string_view what) {
    if (!holds) fail(what);
}

/// Reads values off the bytes from the front; zeros once they are used up.
class Input {
public:
    Input(const std::uint8_t* data, std::size_t size) : left_(data, size) {}

    std::uint8_t byte() {
        if (left_.empty()) return 0;
        const std::uint8_t first = left_.front();
        left_ = left_.subspan(1);
        return first;
    }
    std::uint32_t word() {
        std::uint32_t value = 0;
        for (int i = 0; i < 4; ++i) value = value << 8 | byte();
        return value;
    }
    bool flag() { return byte() & 1; }
    int between(int low, int high) { return low + int(byte() % unsigned(high - low + 1)); }
    /// From 0 to 1.
    double share() { return double(word()) / 4294967295.0; }
    double between(double low, double high) { return low + (high - low) * share(); }
    /// One of kNumbers, or one of a common size.
    double number() {
        const std::uint8_t which = byte();
        return which < 128 ? kNumbers[which % kNumbers.size()] : between(-1000.0, 1000.0);
    }
    double finiteNumber() { return kNumbers[byte() % kFinite]; }
    std::span<const std::uint8_t> rest() const { return left_; }

private:
    std::span<const std::uint8_t> left_;
};

/// Writes one input to start from, when the fuzzer is asked for them: where SOTERRAIN_FUZZ_SEEDS names a folder.
void writeSeed(const std::string& name, std::string_view bytes);

}  // namespace fuzz
