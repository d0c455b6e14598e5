#pragma once

#include "cases/stepped_run.h"

#include <memory>
#include <string>

namespace antiform::cases
{
/// A run that is loaded from event to event: each step is a load step and the balance
/// after it, and the checkpoint is that of the last record. A signal or the end of the
/// time gives up the load step at hand, which a resumed run takes again.
class EventRun : public SteppedRun
{
public:
  using SteppedRun::SteppedRun;

private:
  /// Where the physics stops the run the state of the last record stays on disk.
  Pause advance() override;
  int steps_between_looks() const override { return 1; }
  std::string loading_in_words() const override;
  std::unique_ptr<SteppedRun> another(const Parameters &parameters,
                                      const RunOptions &options) const override;
  void go_back_to(const coupling::StateWriter &last_record);

  bool has_recorded_ = false; ///< since this start
};
} // namespace antiform::cases
