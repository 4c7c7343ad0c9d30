// What source_version.cmake tells of a work tree, on small repositories made for it.

#include <gtest/gtest.h>

#include <sstream>

#include "experiments/harness/provenance.h"
#include "tests/unit/harness/process.h"

namespace touchstone::harness {
namespace {

using test::Scratch;
using test::slurp;
using test::spit;

class SourceVersion : public testing::Test {
 protected:
  SourceVersion() {
    for (const char* part : {"core", "baselines", "experiments"}) spit(tree() / part / "a.h", part);
    spit(tree() / ".gitignore", "*.o\n");
  }

  [[nodiscard]] std::filesystem::path tree() const { return scratch_ / "tree"; }

  test::Finished git(std::vector<std::string> words) const {
    words.insert(words.begin(), {"git", "-C", tree().string(), "-c", "user.name=n", "-c", "user.email=e@x"});
    test::Finished finished = test::run(words);
    EXPECT_EQ(finished.code, 0) << words[7] << ": " << finished.err;
    return finished;
  }
  void commit() const {
    git({"init", "--quiet"});
    git({"add", "."});
    git({"commit", "--quiet", "--message", "m"});
  }

  /// The header that the script writes.
  [[nodiscard]] std::string header() const {
    const std::string output = scratch_ / "generated" / "version.h";
    const auto finished = test::run({"cmake", "-D", "SOURCE_DIR=" + tree().string(), "-D", "OUTPUT=" + output,
                                     "-P", SOURCE_VERSION_SCRIPT});
    EXPECT_EQ(finished.code, 0) << finished.err;
    return slurp(output);
  }
  [[nodiscard]] static bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }
  /// The line of the header that defines `name`.
  [[nodiscard]] static std::string line(const std::string& header, const std::string& name) {
    std::istringstream in(header);
    for (std::string text; std::getline(in, text);) {
      if (has(text, name)) return text;
    }
    return "none";
  }

 private:
  Scratch scratch_;
};

TEST_F(SourceVersion, OfACommittedTreeIsGitsTreeIds) {
  commit();
  const std::string text = header();
  for (const char* part : {"core", "baselines", "experiments"}) {
    std::string id = git({"rev-parse", std::string("HEAD:") + part}).out;
    id.pop_back();
    EXPECT_TRUE(has(text, id)) << part << "\n" << text;
  }
  EXPECT_TRUE(has(line(text, "kSourcesDirty"), "false"));
}

TEST_F(SourceVersion, FollowsContentsCommittedOrNot) {
  commit();
  const std::string before = header();
  spit(tree() / "core/a.h", "changed");
  spit(tree() / "experiments/new.cpp", "not known to git");
  const std::string changed = header();
  EXPECT_NE(line(changed, "kCoreTree"), line(before, "kCoreTree"));
  EXPECT_NE(line(changed, "kExperimentsTree"), line(before, "kExperimentsTree"));
  EXPECT_EQ(line(changed, "kBaselinesTree"), line(before, "kBaselinesTree"));
  EXPECT_TRUE(has(line(changed, "kSourcesDirty"), "true"));
  commit();
  const std::string committed = header();
  for (const char* name : {"kCoreTree", "kExperimentsTree", "kBaselinesTree"}) {
    EXPECT_EQ(line(committed, name), line(changed, name)) << "the same contents";
  }
  EXPECT_TRUE(has(line(committed, "kSourcesDirty"), "false"));
}

TEST_F(SourceVersion, IgnoredFilesAndOtherFoldersDoNotMatter) {
  commit();
  const std::string before = header();
  spit(tree() / "core/a.o", "object");
  spit(tree() / "results/a.csv", "1");
  EXPECT_EQ(header(), before);
}

TEST_F(SourceVersion, ReadsTheRepositoryAndLeavesItAsItWas) {
  commit();
  spit(tree() / "core/a.h", "changed");
  const std::string status = git({"status", "--porcelain"}).out;
  const std::string objects = git({"count-objects"}).out;
  const std::string index = slurp(tree() / ".git/index");
  static_cast<void>(header());
  EXPECT_EQ(slurp(tree() / ".git/index"), index);
  EXPECT_EQ(git({"count-objects"}).out, objects);
  EXPECT_EQ(git({"status", "--porcelain"}).out, status);
}

TEST_F(SourceVersion, WithoutARepositoryOfItsOwnIsUnknown) {
  const std::string text = header();
  for (const char* name : {"kCoreTree", "kExperimentsTree", "kBaselinesTree"}) {
    EXPECT_TRUE(has(line(text, name), "\"unknown\"")) << text;
  }
  // Nor does it take a repository around it for its own.
  test::run({"git", "init", "--quiet", tree().parent_path().string()});
  EXPECT_TRUE(has(line(header(), "kCoreTree"), "\"unknown\""));
}

TEST(Provenance, OfATableIsTheSameEveryTime) {
  const Provenance provenance{"toy", "toy --until 1", {}, std::nullopt};
  EXPECT_EQ(meta_json(provenance, "summary"), meta_json(provenance, "summary"));
  EXPECT_NE(meta_json(provenance, "summary").find("\"seed\": null"), std::string::npos);
  EXPECT_EQ(meta_json(provenance, "summary").find("host"), std::string::npos);
}

TEST(Provenance, AStampDependsOnEnginesButNotOnTheCommand) {
  const Provenance one{"toy", "toy --until 1", {{"ode", "0.16"}}, std::nullopt};
  Provenance other = one;
  other.command = "toy --until 2";
  EXPECT_EQ(build_stamp(one), build_stamp(other));
  other.engines["ode"] = "0.17";
  EXPECT_NE(build_stamp(one), build_stamp(other));
}

}  // namespace
}  // namespace touchstone::harness
