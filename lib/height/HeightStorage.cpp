#include "height/HeightStorage.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace terrain {

namespace {

std::string systemReason(int code) {
    return std::generic_category().message(code);
}

std::size_t pageBytes() {
    static const std::size_t bytes = std::size_t(sysconf(_SC_PAGESIZE));
    return bytes;
}

/// Bytes of mapped files of this process that are resident; 0 where the system does not tell.
std::size_t residentFileBytes() {
    std::ifstream status("/proc/self/statm");
    std::size_t total = 0, resident = 0, shared = 0;
    status >> total >> resident >> shared;
    return status ? shared * pageBytes() : 0;
}

}  // namespace

ScratchMapping::~ScratchMapping() {
    munmap(begin_, count_ * sizeof(float));
}

/// Only what lies in whole pages: the ones at the ends may be in use for others.
void ScratchMapping::release(std::size_t first, std::size_t count) const {
    const std::size_t page = pageBytes(), bytes = count_ * sizeof(float);
    const std::size_t last = std::min(first + count, count_) * sizeof(float);
    const std::size_t from = (first * sizeof(float) + page - 1) / page * page;
    const std::size_t to = last == bytes ? (bytes + page - 1) / page * page : last / page * page;
    if (from < to) madvise(static_cast<char*>(begin_) + from, to - from, MADV_DONTNEED);
}

void ScratchMapping::limitResident(std::size_t bytes) const {
    // What is resident after a release are other files of the process, its libraries among them.
    if (residentFileBytes() < others_ + bytes) return;
    release(0, count_);
    others_ = residentFileBytes();
}

bool HeightStorage::operator==(const HeightStorage& other) const {
    return std::equal(begin(), end(), other.begin(), other.end());
}

void HeightStorage::moveIntoMemory() {
    memory_.assign(mapping_->data(), mapping_->data() + mapping_->size());
    mapping_.reset();
}

Result<HeightStorage> HeightStorage::copy() const {
    if (!mapping_) return HeightStorage(memory_);
    auto writer = ScratchWriter::create("copy of a height map", size());
    if (!writer) return writer.error();
    constexpr std::size_t kPiece = std::size_t(1) << 20;
    for (std::size_t first = 0; first < size(); first += kPiece) {
        const std::size_t count = std::min(kPiece, size() - first);
        if (auto problem = writer.value().write(first, data() + first, count)) return *problem;
        releasePages(first, count);
    }
    return std::move(writer).value().finish();
}

Error ScratchWriter::problem(const std::string& found) const {
    return Error{subject_, std::to_string(count_ * sizeof(float)) + " bytes of scratch space in " + folder_ + " (see TMPDIR)",
                 found};
}

Result<ScratchWriter> ScratchWriter::create(const std::string& subject, std::uint64_t count) {
    ScratchWriter writer;
    writer.subject_ = subject;
    writer.count_ = count;
    writer.folder_ = "the directory for temporary files";
    const std::uint64_t bytes = count * sizeof(float);
    std::error_code failure;
    const std::filesystem::path folder = std::filesystem::temp_directory_path(failure);
    if (failure) return writer.problem(failure.message());
    writer.folder_ = folder.string();
    const auto space = std::filesystem::space(folder, failure);
    if (!failure && space.available < bytes) return writer.problem(std::to_string(space.available) + " bytes");
    // Writing beyond this limit would end the program by a signal.
    rlimit limit{};
    if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && limit.rlim_cur < bytes)
        return writer.problem("a limit of " + std::to_string(limit.rlim_cur) + " bytes a file");
    std::string name = (folder / "soterrain-XXXXXX").string();
    writer.file_ = mkostemp(name.data(), O_CLOEXEC);
    if (writer.file_ < 0) return writer.problem(systemReason(errno));
    unlink(name.c_str());
    return writer;
}

ScratchWriter::ScratchWriter(ScratchWriter&& other) noexcept
    : subject_(std::move(other.subject_)), folder_(std::move(other.folder_)), count_(other.count_),
      file_(std::exchange(other.file_, -1)) {}

ScratchWriter& ScratchWriter::operator=(ScratchWriter&& other) noexcept {
    std::swap(subject_, other.subject_);
    std::swap(folder_, other.folder_);
    std::swap(count_, other.count_);
    std::swap(file_, other.file_);
    return *this;
}

ScratchWriter::~ScratchWriter() {
    if (file_ >= 0) close(file_);
}

std::optional<Error> ScratchWriter::write(std::uint64_t first, const float* heights, std::size_t count) {
    const char* from = reinterpret_cast<const char*>(heights);
    std::size_t left = count * sizeof(float);
    off_t place = off_t(first * sizeof(float));
    while (left > 0) {
        const ssize_t written = pwrite(file_, from, left, place);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return problem(written < 0 ? systemReason(errno) : "no more to be had");
        from += written;
        left -= std::size_t(written);
        place += written;
    }
    return std::nullopt;
}

Result<HeightStorage> ScratchWriter::finish() && {
    const std::size_t bytes = std::size_t(count_) * sizeof(float);
    struct stat status {};
    if (fstat(file_, &status) != 0 || std::uint64_t(status.st_size) != bytes)
        return problem(std::to_string(std::max<off_t>(status.st_size, 0)) + " bytes written");
    void* begin = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
    if (begin == MAP_FAILED) return problem(systemReason(errno));
    return HeightStorage(std::make_shared<const ScratchMapping>(begin, std::size_t(count_)));
}

}  // namespace terrain
