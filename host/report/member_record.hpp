#pragma once
/// \file member_record.hpp  member.json: what a batch records in the folder of a sequence once the sequence is
/// done.

#include <optional>
#include <string>

namespace quadedge::report {

/// One sequence of a batch that was run, successfully or not.
struct MemberRecord {
  std::string name;    ///< in the batch
  std::string path;    ///< of the recording
  std::string format;  ///< layout; empty if none is recognised
  std::string key;  ///< fingerprint of input, configuration, device and program; empty where the input cannot be opened
  int exit_code = 0;    ///< of the run, see doc/usage.md; 1 if a signal ended it
  std::string message;  ///< why it failed; empty where it did not
  int jobs = 1;  ///< sequences that ran at the same time: with more than one, latencies are not those of a lone run
};

/// Text of member.json. It has no times, so that two runs of the same input give the same bytes.
std::string member_json(const MemberRecord& record);

/// Reads FOLDER/member.json; nothing if it is missing or damaged; the sequence then counts as not run.
std::optional<MemberRecord> read_member(const std::string& folder);

}  // namespace quadedge::report
