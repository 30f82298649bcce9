// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// The name of file functions of SQLite (a VFS) that only read, for databases that may come from
// anywhere. SQLite's own functions write beside a database to read it, and a journal beside it can
// make them delete any file of the user. With these:
// - a database and its log (-wal) are opened for reading only, and must be regular files; the log
//   may not be a link, and without one the log is empty;
// - no journal is there, and nothing is locked, written or deleted;
// - temporary files are made by SQLite and have no name.
// A database in the mode WAL can be read if its lock is exclusive (PRAGMA locking_mode), because
// SQLite then needs no shared memory. Its path must be absolute.
const char* ReadOnlyVfs();

}  // namespace hullslam
