// Sweeps without stamps, taken to be farther apart.
#include <utility>

#include "io/sources/source_wrappers.hpp"

namespace rilo::detail {
namespace {

class SlowerSource final : public WrappedSource {
 public:
  SlowerSource(std::unique_ptr<ScanSource> inner, int times) : WrappedSource(std::move(inner)), times_(times) {}

  std::optional<Sweep> next() override {
    std::optional<Sweep> sweep = inner_->next();
    if (sweep) sweep->stamp_ns *= times_;
    return sweep;
  }
  SourceInfo info() const override {
    SourceInfo info = inner_->info();
    info.period_s *= times_;
    return info;
  }

 private:
  int times_;
};

}  // namespace

std::unique_ptr<ScanSource> with_slower_stamps(std::unique_ptr<ScanSource> inner, int times) {
  return std::make_unique<SlowerSource>(std::move(inner), times);
}

}  // namespace rilo::detail
