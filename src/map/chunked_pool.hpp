// Elements that stay where they are while more are added.
#pragma once

#include <cstddef>
#include <vector>

namespace rilo {

/// A vector in chunks. It grows without copying: a std::vector of many megabytes pauses the sweep in which it moves,
/// and leaves holes in the heap that together are as large as itself.
template <typename T>
class ChunkedPool {
 public:
  T& operator[](std::size_t i) { return chunks_[i / kChunk][i % kChunk]; }
  const T& operator[](std::size_t i) const { return chunks_[i / kChunk][i % kChunk]; }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  /// Adds a default-constructed element.
  void grow() {
    if (size_ % kChunk == 0) {
      chunks_.emplace_back().reserve(kChunk);
    }
    chunks_.back().emplace_back();
    ++size_;
  }

 private:
  static constexpr std::size_t kChunk = 4096;

  std::vector<std::vector<T>> chunks_;
  std::size_t size_ = 0;
};

}  // namespace rilo
