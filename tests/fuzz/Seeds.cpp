#include "Input.h"

#include <fstream>

namespace fuzz {

void writeSeed(const std::string& name, std::string_view bytes) {
    const char* folder = std::getenv("SOTERRAIN_FUZZ_SEEDS");
    if (!folder || !*folder) return;
    std::ofstream file(std::string(folder) + '/' + name, std::ios::binary);
    file.write(bytes.data(), std::streamsize(bytes.size()));
    check(bool(file), "a seed can't be written");
}

}  // namespace fuzz
