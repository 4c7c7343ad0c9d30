#include "experiments/harness/command_line.h"

#include <gtest/gtest.h>

#include "core/model/errors.h"

namespace touchstone::harness {
namespace {

const CommandLineSpec kSpec = {
    .name = "toy",
    .about = "Does it roll?",
    .examples = "  toy --quick   a first look\n",
    .methods = {"ncp", "lcp"},
    .axes = {{"edges", "edges of the polygon", AxisKind::integer, {"10", "20"}, {"10"}, 3},
             {"step-sizes", "steps [s]", AxisKind::positive, {"0.01", "0.001"}, {"0.01"}},
             {"candidates", "policy", AxisKind::text, {"all"}, {"all"}, 1, {"all", "nearest:1"}}},
    .until = 10,
    .quick_until = 2};

Selection parse(std::vector<const char*> words) {
  words.insert(words.begin(), "toy");
  return parse_command_line(kSpec, static_cast<int>(words.size()), words.data()).value();
}

std::string message_of(const std::vector<const char*>& words) {
  try {
    parse(words);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(CommandLine, DefaultsAreThoseOfTheCommittedResults) {
  const Selection selection = parse({});
  EXPECT_EQ(selection.integers("edges"), (std::vector<int>{10, 20}));
  EXPECT_EQ(selection.numbers("step-sizes"), (std::vector<double>{0.01, 0.001}));
  EXPECT_EQ(selection.texts("candidates"), (std::vector<std::string>{"all"}));
  ASSERT_EQ(selection.methods.size(), 2u);
  EXPECT_EQ(selection.methods[0].key, "ncp");
  EXPECT_EQ(selection.until, 10);
  EXPECT_TRUE(selection.shard.whole());
  EXPECT_FALSE(selection.list);
  EXPECT_EQ(selection.out, "results/toy");
  EXPECT_GE(selection.jobs, 1);
  EXPECT_EQ(selection.command,
            "toy --methods ncp,lcp --edges 10,20 --step-sizes 0.01,0.001 --candidates all --until 10");
}

TEST(CommandLine, EveryOptionIsRead) {
  const Selection selection =
      parse({"--methods", "lcp:a=1;b=nearest:2,ncp", "--edges", "7,5", "--step-sizes", "1e-2", "--candidates",
             "nearest:1", "--until", "3", "--jobs", "3", "--shard", "2/4", "--out", "here", "--list"});
  EXPECT_EQ(selection.methods[0].options, (Options{{"a", "1"}, {"b", "nearest:2"}}));
  EXPECT_EQ(selection.integers("edges"), (std::vector<int>{7, 5}));
  EXPECT_EQ(selection.texts("step-sizes"), (std::vector<std::string>{"0.01"}));
  EXPECT_EQ(selection.texts("candidates"), (std::vector<std::string>{"nearest:1"}));
  EXPECT_EQ(selection.until, 3);
  EXPECT_EQ(selection.jobs, 3);
  EXPECT_EQ(selection.shard.index, 2);
  EXPECT_EQ(selection.shard.count, 4);
  EXPECT_EQ(selection.out, "here");
  EXPECT_TRUE(selection.list);
  EXPECT_EQ(selection.command,
            "toy --methods 'lcp:a=1;b=nearest:2,ncp' --edges 7,5 --step-sizes 0.01 --candidates nearest:1 "
            "--until 3");
}

TEST(CommandLine, QuickTakesItsOwnValuesUnlessOthersAreGiven) {
  const Selection quick = parse({"--quick"});
  EXPECT_EQ(quick.integers("edges"), (std::vector<int>{10}));
  EXPECT_EQ(quick.until, 2);
  const Selection mixed = parse({"--quick", "--edges", "50", "--until", "4"});
  EXPECT_EQ(mixed.integers("edges"), (std::vector<int>{50}));
  EXPECT_EQ(mixed.until, 4);
}

TEST(CommandLine, TheCommandTellsValuesAndNotHowTheyWereAskedFor) {
  EXPECT_EQ(parse({"--edges", "10,20", "--jobs", "1", "--out", "x", "--step-sizes", "1e-2,0.0010"}).command,
            parse({}).command);
}

TEST(CommandLine, BadValuesAreNamedWithWhatIsAllowed) {
  EXPECT_EQ(message_of({"--step-sizes", "0"}), "--step-sizes: got '0', allowed: a finite number > 0");
  EXPECT_EQ(message_of({"--step-sizes", "0.01,-1"}), "--step-sizes: got '-1', allowed: a finite number > 0");
  EXPECT_EQ(message_of({"--step-sizes", "nan"}), "--step-sizes: got 'nan', allowed: a finite number > 0");
  EXPECT_EQ(message_of({"--step-sizes", "inf"}), "--step-sizes: got 'inf', allowed: a finite number > 0");
  EXPECT_EQ(message_of({"--edges", "2"}), "--edges: got '2', allowed: an integer >= 3");
  EXPECT_EQ(message_of({"--edges", "10.5"}), "--edges: got '10.5', allowed: an integer >= 3");
  EXPECT_EQ(message_of({"--edges", "99999999999"}), "--edges: got '99999999999', allowed: an integer >= 3");
  EXPECT_EQ(message_of({"--edges", "10,10"}), "--edges: got '10' twice, allowed: each value once");
  EXPECT_EQ(message_of({"--step-sizes", "0.1,1e-1"}),
            "--step-sizes: got '0.1' twice, allowed: each value once");
  EXPECT_EQ(message_of({"--candidates", "some"}), "--candidates: got 'some', allowed: all, nearest:1");
  EXPECT_EQ(message_of({"--until", "nan"}), "--until: got 'nan', allowed: a finite number > 0");
  EXPECT_EQ(message_of({"--jobs", "0"}), "--jobs: got '0', allowed: an integer from 1 to 4096");
  EXPECT_EQ(message_of({"--methods", "a,a"}), "--methods: got 'a' twice, allowed: each value once");
  EXPECT_EQ(message_of({"--methods", "a:b"}),
            "--methods: got 'a:b', allowed: KEY or KEY:name=value;name=value, each name once");
  for (const char* shard : {"0/2", "3/2", "1", "1/0", "a/b", "1/2/3", "-1/2"}) {
    EXPECT_NE(message_of({"--shard", shard}).find("allowed: i/n with 1 <= i <= n"), std::string::npos)
        << shard;
  }
}

TEST(CommandLine, UnknownOptionsAndMissingValuesAreNamed) {
  EXPECT_NE(message_of({"--steps", "3"}).find("--steps"), std::string::npos);
  EXPECT_NE(message_of({"--steps", "3"}).find("--step-sizes"), std::string::npos) << "what is allowed";
  EXPECT_NE(message_of({"--edges"}).find("--edges"), std::string::npos);
}

TEST(CommandLine, HelpTeachesAndEnds) {
  testing::internal::CaptureStdout();
  const char* words[] = {"toy", "--help"};
  EXPECT_FALSE(parse_command_line(kSpec, 2, words));
  const std::string help = testing::internal::GetCapturedStdout();
  for (const char* part : {"Does it roll?", "--edges", "edges of the polygon", "toy --quick", "Exit codes"}) {
    EXPECT_NE(help.find(part), std::string::npos) << part << "\n" << help;
  }
}

TEST(CommandLine, MethodsReadAndWriteTheSame) {
  for (const char* text : {"ncp", "lcp:candidates=nearest:2;edges=10"}) {
    EXPECT_EQ(format_method(parse_method(text)), text);
  }
  EXPECT_THROW(parse_method(":a=1"), InputError);
  EXPECT_THROW(parse_method(""), InputError);
  EXPECT_THROW(parse_method("a:"), InputError);
  EXPECT_THROW(parse_method("a:b=1;b=2"), InputError);
}

TEST(CommandLine, ShardsDealOutEveryCaseOnce) {
  for (std::size_t i = 0; i < 20; ++i) {
    int owners = 0;
    for (int k = 1; k <= 3; ++k) owners += Shard{k, 3}.contains(i) ? 1 : 0;
    EXPECT_EQ(owners, 1);
  }
}

}  // namespace
}  // namespace touchstone::harness
