// Stands in for libFuzzer where the compiler has none: the same inputs, changed at random without regard to what they reach.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "Input.h"

extern "C" {
std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
__attribute__((weak)) std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed);
__attribute__((weak)) void __sanitizer_set_death_callback(void (*callback)());
}

namespace {

using Bytes = std::vector<std::uint8_t>;

struct {
    Bytes input;
    std::string artifact;
} current;

std::mt19937 generator;

/// Of what is safe in a signal handler.
void keepInput() {
    const int file = open(current.artifact.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644);
    if (file < 0) return;
    const auto written = write(file, current.input.data(), current.input.size());
    constexpr char kept[] = "==fuzz== the input was kept: ";
    const auto told =
        write(2, kept, sizeof kept - 1) + write(2, current.artifact.data(), current.artifact.size()) + write(2, "\n", 1);
    (void)written, (void)told;
    close(file);
}

void crashed(int signal) {
    keepInput();
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

std::size_t valueOf(std::string_view argument, std::string_view name, std::size_t otherwise) {
    return argument.starts_with(name) ? std::strtoull(argument.data() + name.size(), nullptr, 10) : otherwise;
}

std::vector<Bytes> readFolder(const std::string& folder) {
    std::vector<std::string> paths;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder, none)) paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    std::vector<Bytes> inputs;
    for (const std::string& path : paths) {
        std::ifstream file(path, std::ios::binary);
        inputs.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    }
    return inputs;
}

void run(Bytes input, unsigned timeout) {
    current.input = std::move(input);
    alarm(timeout);
    // A copy of exactly this size, so that the sanitizer sees what reads beyond it.
    const Bytes exact(current.input);
    LLVMFuzzerTestOneInput(exact.data(), exact.size());
    alarm(0);
}

}  // namespace

std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most) {
    for (unsigned edits = 1 + generator() % 4; edits > 0; --edits) {
        const std::size_t at = size ? generator() % size : 0;
        switch (generator() % 4) {
        case 0:
            if (size < most) {
                std::memmove(data + at + 1, data + at, size - at);
                data[at] = std::uint8_t(generator());
                ++size;
            }
            break;
        case 1:
            if (size > 1) std::memmove(data + at, data + at + 1, --size - at);
            break;
        case 2:
            if (size) data[at] ^= std::uint8_t(1u << generator() % 8);
            break;
        default:
            if (size) data[at] = std::uint8_t(generator());
        }
    }
    return size;
}

int main(int argc, char** argv) {
    std::size_t seconds = 0, seed = 1, timeout = 10;
    std::string prefix;
    std::vector<Bytes> corpus;
    LLVMFuzzerInitialize(&argc, &argv);
    for (const char* const argument : std::span(argv + 1, std::size_t(argc - 1))) {
        const std::string_view text(argument);
        seconds = valueOf(text, "-max_total_time=", seconds);
        seed = valueOf(text, "-seed=", seed);
        timeout = valueOf(text, "-timeout=", timeout);
        if (text.starts_with("-artifact_prefix=")) prefix = text.substr(text.find('=') + 1);
        if (text.starts_with("-")) continue;
        if (std::filesystem::is_directory(text)) {
            std::ranges::move(readFolder(argument), std::back_inserter(corpus));
        } else {
            std::ifstream file(argument, std::ios::binary);
            corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
        }
    }
    current.artifact = prefix + "crash-input";
    generator.seed(std::uint32_t(seed));
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM}) std::signal(signal, crashed);
    if (__sanitizer_set_death_callback) __sanitizer_set_death_callback(keepInput);
    std::size_t runs = 0;
    for (const Bytes& input : corpus) run(input, unsigned(timeout)), ++runs;
    if (corpus.empty()) corpus.emplace_back();
    constexpr std::size_t kMost = 4096;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
    for (; std::chrono::steady_clock::now() < end; ++runs) {
        Bytes input = corpus[generator() % corpus.size()];
        std::size_t size = input.size();
        const std::size_t most = std::max(kMost, size);
        input.resize(most);
        const auto mutate = [&] {
            return LLVMFuzzerCustomMutator ? LLVMFuzzerCustomMutator(input.data(), size, most, generator())
                                           : LLVMFuzzerMutate(input.data(), size, most);
        };
        for (unsigned rounds = 1 + generator() % 5; rounds > 0; --rounds) size = mutate();
        input.resize(size);
        run(std::move(input), unsigned(timeout));
    }
    std::fprintf(stderr, "stat::number_of_executed_units: %zu\n", runs);
    return 0;
}
