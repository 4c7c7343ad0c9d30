#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/method.h"
#include "core/surfaces/convex_surface.h"
#include "experiments/harness/csv.h"
#include "experiments/harness/files.h"
#include "experiments/harness/ledger.h"

namespace touchstone::program {

/// Written only for methods that estimate their error.
inline constexpr const char* kErrorEstimateFile = "error_estimate.csv";

/// A CSV that grows as text, because a long trajectory does not fit in memory cell by cell.
class CsvText {
 public:
  explicit CsvText(harness::Row header);

  /// Appends rows, sorted among themselves.
  void append(std::vector<harness::Row> rows);
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  harness::Row header_;
  std::string text_;
};

/// trajectory.csv, contacts.csv and energy.csv of one run, and error_estimate.csv of a method that has an
/// estimate. Everything is in the world frame; a planar scene
/// is written as the plane z = 0 of space.
template <int Dim>
class Recorder {
 public:
  /// @param method  must outlive the recorder
  explicit Recorder(const Method<Dim>& method);

  /// Notes the method's state at `t` [s].
  /// @param h  size of the step that led to it [s]; 0 at the start, where no contact has acted yet
  void record(double t, double h, const EnergyLedger<Dim>& ledger);

  [[nodiscard]] std::vector<harness::FileContent> files(const std::filesystem::path& folder) const;

 private:
  void record_bodies(const std::string& t);
  void record_contacts(const std::string& t, double h);
  void record_estimate(const std::string& t);
  void record_energy(const std::string& t, const EnergyLedger<Dim>& ledger);
  [[nodiscard]] double gap(const ContactImpulse<Dim>& contact) const;

  const Method<Dim>& method_;
  std::vector<std::shared_ptr<const ConvexSurface<Dim>>> surfaces_;
  CsvText trajectory_;
  CsvText contacts_;
  CsvText energy_;
  CsvText estimate_;
};

}  // namespace touchstone::program
