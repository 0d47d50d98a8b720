#include "cloud/voxel_mean.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "cloud/fixed_chunks.hpp"
#include "cloud/point_block.hpp"
#include "geometry/voxel_key.hpp"

namespace rilo {

namespace {
constexpr std::uint64_t kSecondHalf = 1ULL << 63U;  // a bit that voxel_key leaves free

/// Sign of y of a voxel, a bit of its key.
std::uint64_t side_of(std::uint64_t key) { return key >> 41U & 1U; }
}  // namespace

void VoxelMean::find_runs(const TimedCloud& in, double voxel_m) {
  const bool timed = in.timed();
  const double inverse = 1.0 / voxel_m;
  runs_.keys.resize(in.size());
  runs_.starts.resize(in.size());
  runs_.counts.resize(chunk_count(in.size()));
  for_fixed_chunks(in.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    PointBlock p;
    alignas(64) PointBlock::Lanes<std::uint64_t> keys;
    std::uint64_t* const to = &runs_.keys[begin];
    std::uint16_t* const starts = &runs_.starts[begin];
    std::uint64_t before = 0;
    std::size_t count = 0;
    for_each_block(begin, end, [&](std::size_t first, std::size_t n) {
      p.load(&in.points[first], n);
      find_voxel_keys(p, inverse, keys);
      for (std::size_t i = 0; i < n; ++i) {
        const std::uint64_t key = keys[i] | (timed && in.offsets_s[first + i] > 0.0F ? kSecondHalf : 0U);
        // Written in any case, counted if it begins a run: no branch.
        to[count] = key;
        starts[count] = static_cast<std::uint16_t>(first + i - begin);
        count += static_cast<std::size_t>(key != before || count == 0);
        before = key;
      }
    });
    runs_.counts[chunk] = static_cast<std::uint16_t>(count);
  });
}

void VoxelMean::Side::start() {
  means_.clear();
  if (slots_.empty() || ++generation_ == 0) {  // after 2^32 calls the old marks would come back to life
    slots_.assign(std::max(kFirstVoxelSlots, slots_.size()), Slot{});
    generation_ = 1;
  }
}

/// Number of the mean of the voxel `key`; that of the next one to come if the voxel is new.
std::uint32_t VoxelMean::Side::number_of(std::uint64_t key) {
  const std::uint64_t mask = slots_.size() - 1;
  std::uint64_t slot = mix_key(key) & mask;
  while (slots_[slot].generation == generation_) {
    if (slots_[slot].key == key) {
      return slots_[slot].number;
    }
    slot = (slot + 1) & mask;
  }
  const auto next = static_cast<std::uint32_t>(means_.size());
  slots_[slot] = {key, generation_, next};
  if (means_.size() * 2 > slots_.size()) {
    grow();
  }
  return next;
}

void VoxelMean::Side::grow() {
  const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(slots_.size() * 2));
  const std::uint64_t mask = slots_.size() - 1;
  for (const Slot& taken : old) {
    if (taken.generation != generation_) {
      continue;
    }
    std::uint64_t slot = mix_key(taken.key) & mask;
    while (slots_[slot].generation == generation_) {
      slot = (slot + 1) & mask;
    }
    slots_[slot] = taken;
  }
}

template <typename CountOf>
void VoxelMean::Side::add(const TimedCloud& in, std::uint64_t key, std::size_t begin, std::size_t end,
                          const CountOf& count_of) {
  const bool timed = in.timed();
  const std::uint32_t place = number_of(key);
  if (place == means_.size()) {
    means_.push_back({in.points[begin], timed ? in.offsets_s[begin] : 0.0F});
    means_.back().first_index = static_cast<std::uint32_t>(begin);
  }
  Mean& mean = means_[place];
  const Eigen::Vector3f first = mean.first;
  Eigen::Vector3f sum = mean.sum;
  float total = mean.count;
  for (std::size_t i = begin; i < end; ++i) {
    const float count = count_of(i);
    sum += count * (in.points[i] - first);
    total += count;
  }
  mean.sum = sum;
  mean.count = total;
  if (timed) {
    for (std::size_t i = begin; i < end; ++i) {
      mean.offset_sum_s += count_of(i) * (in.offsets_s[i] - mean.first_offset_s);
    }
  }
  if (!in.intensities.empty()) {
    for (std::size_t i = begin; i < end; ++i) {
      mean.intensity_sum += count_of(i) * in.intensities[i];
    }
  }
}

template <typename CountOf>
void VoxelMean::Side::add_up(const TimedCloud& in, const Runs& runs, std::uint64_t number, const CountOf& count_of) {
  start();
  for (std::size_t chunk = 0; chunk < runs.counts.size(); ++chunk) {
    const std::size_t begin = chunk * kChunkSize;
    const std::size_t end = std::min(in.size(), begin + kChunkSize);
    const std::span keys(&runs.keys[begin], runs.counts[chunk]);
    const std::uint16_t* const starts = &runs.starts[begin];
    for (std::size_t r = 0; r < keys.size(); ++r) {
      if (const std::size_t ahead = r + kLookUpsInFlight; ahead < keys.size() && side_of(keys[ahead]) == number) {
        __builtin_prefetch(&slots_[mix_key(keys[ahead]) & (slots_.size() - 1)]);
      }
      if (side_of(keys[r]) == number) {
        add(in, keys[r], begin + starts[r], r + 1 < keys.size() ? begin + starts[r + 1] : end, count_of);
      }
    }
  }
}

template <typename CountOf>
void VoxelMean::add_up(const TimedCloud& in, const CountOf& count_of) {
  for_each_index(sides_.size(), [&](std::size_t i) { sides_[i].add_up(in, runs_, i, count_of); });
}

void VoxelMean::average(const TimedCloud& in, double voxel_m, TimedCloud& out) {
  find_runs(in, voxel_m);
  if (in.counts.empty()) {
    add_up(in, [](std::size_t) { return 1.0F; });
  } else {
    add_up(in, [&](std::size_t i) { return in.counts[i]; });
  }
  write(in, out);
}

// The sides merged by the first points of their voxels.
void VoxelMean::write(const TimedCloud& in, TimedCloud& out) const {
  const bool timed = in.timed();
  const bool intense = !in.intensities.empty();
  std::size_t size = 0;
  std::array<const Mean*, 2> next{};
  for (std::size_t i = 0; i < next.size(); ++i) {
    next[i] = sides_[i].means().data();
    size += sides_[i].means().size();
  }
  out.points.resize(size);
  out.counts.resize(size);
  out.offsets_s.resize(timed ? size : 0);
  out.intensities.resize(intense ? size : 0);
  constexpr std::uint32_t kEnd = std::numeric_limits<std::uint32_t>::max();
  const auto first_of = [&](std::size_t i) {
    const std::vector<Mean>& means = sides_[i].means();
    return next[i] == means.data() + means.size() ? kEnd : next[i]->first_index;
  };
  for (std::size_t n = 0; n < size;) {
    const std::size_t least = first_of(0) < first_of(1) ? 0 : 1;
    const std::uint32_t until = first_of(1 - least);
    for (; first_of(least) < until; ++n, ++next[least]) {
      const Mean& mean = *next[least];
      out.points[n] = mean.first + mean.sum / mean.count;
      out.counts[n] = mean.count;
      if (timed) {
        out.offsets_s[n] = mean.first_offset_s + mean.offset_sum_s / mean.count;
      }
      if (intense) {
        out.intensities[n] = mean.intensity_sum / mean.count;
      }
    }
  }
}

}  // namespace rilo
