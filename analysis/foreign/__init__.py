"""Binary files of other programs, read in a process of their own.

The libraries that read them are partly C: a damaged file may end the process, go round for ever or
ask for all memory. So a child process reads, within limits of memory and time, and hands on plain
numbers; when it dies, its parent has one sentence to say and goes on. Which files there are, and
what of them is a recording, is told in :mod:`analysis.readers`.
"""
