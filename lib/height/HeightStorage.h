// Where the samples of a height map lie: in memory, or in scratch space on disk that is mapped.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/Result.h"

namespace terrain {

/// A file of floats without a name, mapped: it is gone when the last one who uses it goes.
class ScratchMapping {
public:
    /// Takes a mapping of `count` floats.
    ScratchMapping(void* begin, std::size_t count) : begin_(begin), count_(count) {}
    ~ScratchMapping();
    ScratchMapping(const ScratchMapping&) = delete;
    ScratchMapping& operator=(const ScratchMapping&) = delete;

    const float* data() const { return static_cast<const float*>(begin_); }
    /// What is written there goes to the file when its pages are released.
    float* writable() const { return static_cast<float*>(begin_); }
    std::size_t size() const { return count_; }
    void release(std::size_t first, std::size_t count) const;
    void limitResident(std::size_t bytes) const;

private:
    void* begin_;
    std::size_t count_;
    mutable std::atomic<std::size_t> others_{0};  ///< resident bytes of the process's other files when they were last looked at
};

/// Consecutive floats, as a std::vector has them, either in memory or in scratch space (ScratchWriter), in which case their pages
/// come and go: what is resident is what was read since releasePages(). Reading is the same for both. A copy of mapped floats
/// shares them; the first change of mapped floats copies them all into memory.
///
/// Reading, releasing included, may be done by any number of threads at once.
class HeightStorage {
public:
    using value_type = float;
    using const_iterator = const float*;
    using iterator = float*;

    HeightStorage() = default;
    HeightStorage(std::vector<float> heights) : memory_(std::move(heights)) {}
    HeightStorage(std::initializer_list<float> heights) : memory_(heights) {}
    HeightStorage(std::shared_ptr<const ScratchMapping> mapping) : mapping_(std::move(mapping)) {}

    std::size_t size() const { return mapping_ ? mapping_->size() : memory_.size(); }
    bool empty() const { return size() == 0; }
    const float* data() const { return mapping_ ? mapping_->data() : memory_.data(); }
    const float& operator[](std::size_t i) const { return data()[i]; }
    const float* begin() const { return data(); }
    const float* end() const { return data() + size(); }
    const float& back() const { return data()[size() - 1]; }
    bool operator==(const HeightStorage& other) const;

    float* data() { return changeable().data(); }
    float& operator[](std::size_t i) { return changeable()[i]; }
    float* begin() { return data(); }
    float* end() { return data() + size(); }
    float& back() { return changeable().back(); }
    void reserve(std::size_t count) { changeable().reserve(count); }
    void resize(std::size_t count) { changeable().resize(count); }
    void assign(std::size_t count, float height) { changeable().assign(count, height); }
    void push_back(float height) { changeable().push_back(height); }
    void pop_back() { changeable().pop_back(); }

    /// To write some of the floats in place. Mapped ones stay in scratch space, where every storage that shares them sees it.
    float* change() { return mapping_ ? mapping_->writable() : memory_.data(); }
    /// The same floats in memory or scratch space of their own, as these are. Error: no scratch space for them.
    Result<HeightStorage> copy() const;

    bool isMapped() const { return mapping_ != nullptr; }
    /// Bytes that are always in memory: none of mapped floats.
    std::size_t memoryBytes() const { return memory_.capacity() * sizeof(float); }
    /// The floats [first, first + count) will not be read again soon: their pages are no longer resident. A hint; costs nothing for
    /// floats in memory.
    void releasePages(std::size_t first, std::size_t count) const {
        if (mapping_) mapping_->release(first, count);
    }
    /// Releases all when mapped floats (of any storage of this process) take more than `bytes` of memory. To be called now and then
    /// by who reads them here and there.
    void limitResident(std::size_t bytes) const {
        if (mapping_) mapping_->limitResident(bytes);
    }

private:
    std::vector<float>& changeable() {
        if (mapping_) moveIntoMemory();
        return memory_;
    }
    void moveIntoMemory();

    std::vector<float> memory_;  ///< empty while mapped
    std::shared_ptr<const ScratchMapping> mapping_;
};

/// Writes floats to an unnamed temporary file, in any order, and maps it. The file lies in the directory for temporary files
/// (std::filesystem::temp_directory_path(), hence TMPDIR), and leaves it before it has any contents, so nothing stays behind
/// whatever happens.
class ScratchWriter {
public:
    /// `subject`: what errors are about. Error: no such directory, no permission, fewer bytes free than the floats take.
    static Result<ScratchWriter> create(const std::string& subject, std::uint64_t count);
    ScratchWriter(ScratchWriter&& other) noexcept;
    ScratchWriter& operator=(ScratchWriter&& other) noexcept;
    ~ScratchWriter();

    /// Writes floats from index `first` on. The system's reason when it can't, no space left for one.
    std::optional<Error> write(std::uint64_t first, const float* heights, std::size_t count);
    /// The floats, all of which must have been written: a page without any behind it could not be read.
    Result<HeightStorage> finish() &&;

private:
    ScratchWriter() = default;
    Error problem(const std::string& found) const;

    std::string subject_;
    std::string folder_;
    std::uint64_t count_ = 0;
    int file_ = -1;
};

}  // namespace terrain
