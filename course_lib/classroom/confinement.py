"""Walls that a process raises about itself before it runs a stranger's code, by means of the Linux kernel.

No other program and no root is needed: Landlock (which files), seccomp (which system calls), limits of resources, and
where it runs as root the capabilities given up. Each wall answers whether the kernel built it; what they really hold
back is tried out by `sandbox.probe`. Once raised, no wall can be taken down by the process or its children.

Sources: linux/landlock.h, linux/seccomp.h, linux/filter.h, linux/capability.h of Linux 6.12, the kernel's tables of
system calls. Landlock knows no exceptions beneath a folder, so what may be read is a list of files and whole folders.
"""

import ctypes
import os
import platform
import resource
import struct
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple


class Limits(NamedTuple):
    """What one answer may use. All are chosen: an honest answer takes milliseconds and some megabytes."""

    call_seconds: float = 20.0
    """One call of the student's function, after which it is asked to stop."""
    seconds: float = 60.0
    """All calls of one answer, by the clock and of processor time, after which its process is killed."""
    memory_mb: int = 1000
    """Memory beyond what Python and the course's library take themselves."""
    printed_kb: int = 256
    """What may be printed."""
    answers_mb: int = 64
    """What may be answered."""
    file_mb: int = 16
    """The largest file that may be written."""
    folder_mb: int = 64
    """All files in the answer's own folder."""
    files: int = 64
    """Files open at a time."""
    threads: int = 32
    """Threads at a time; processes there are none but the one."""


class ConfinementError(OSError):
    """The kernel does not build a wall; the message names it."""


def raise_walls(readable: Iterable[Path], listable: Iterable[Path], own_folder: Path, limits: Limits) -> list[str]:
    """Raise all walls about this process; returns a sentence for each that this machine does not have."""
    missing = []
    for wall in (
        give_up_capabilities,
        lambda: limit_resources(limits),
        lambda: limit_files(readable, listable, own_folder),
        limit_system_calls,
    ):
        try:
            wall()
        except (OSError, AttributeError, ValueError) as error:
            missing.append(str(error))
    return missing


# Resources


def limit_resources(limits: Limits) -> None:
    """Processor time, address space, size of a file, open files, no core dump; also the hard limits."""
    seconds = int(limits.seconds) + 1
    wanted = {
        resource.RLIMIT_CPU: seconds,
        resource.RLIMIT_FSIZE: limits.file_mb << 20,
        resource.RLIMIT_NOFILE: limits.files,
        resource.RLIMIT_CORE: 0,
        resource.RLIMIT_AS: address_space() + (limits.memory_mb << 20),
    }
    for which, most in wanted.items():
        hard = resource.getrlimit(which)[1]
        most = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(which, (most, most))


def address_space() -> int:
    """Bytes of address space that this process has taken already."""
    return int(Path("/proc/self/statm").read_text("ascii").split()[0]) * resource.getpagesize()


# Rights of root


def give_up_capabilities() -> None:
    """No right of root is left, and none can be won by starting a program (`no_new_privs`)."""
    libc = _libc()
    _must(libc.prctl(38, 1, 0, 0, 0), "no_new_privs")  # PR_SET_NO_NEW_PRIVS
    for capability in range(64):
        libc.prctl(24, capability, 0, 0, 0)  # PR_CAPBSET_DROP; EINVAL beyond the last one, EPERM where not root
    header = struct.pack("=Ii", 0x20080522, 0)  # _LINUX_CAPABILITY_VERSION_3, this process
    _must(libc.capset(header, bytes(24)), "capabilities")


# Files: Landlock

EXECUTE, WRITE_FILE, READ_FILE, READ_DIR, REMOVE_DIR, REMOVE_FILE = (1 << bit for bit in range(6))
MAKE_REG = 1 << 8
TRUNCATE = 1 << 14
OF_FILES = EXECUTE | WRITE_FILE | READ_FILE | TRUNCATE | 1 << 15
HANDLED_BY_ABI = {1: (1 << 13) - 1, 2: (1 << 14) - 1, 3: (1 << 15) - 1, 4: (1 << 15) - 1, 5: (1 << 16) - 1}
NETWORK = 0b11  # bind and connect of TCP, from ABI 4
SCOPED = 0b11  # abstract sockets and signals, from ABI 6
CREATE_RULESET, ADD_RULE, RESTRICT_SELF = 444, 445, 446
PATH_BENEATH = 1


def limit_files(readable: Iterable[Path], listable: Iterable[Path], own_folder: Path) -> None:
    """Only `readable` files and folders are read, names in `listable` folders listed; all else in `own_folder` alone.

    Raises `ConfinementError` where the kernel has no Landlock.
    """
    libc = _libc()
    abi = libc.syscall(CREATE_RULESET, None, 0, 1)
    if abi < 1:
        raise ConfinementError("Landlock (Linux 5.13 or newer, switched on) is missing: files are not protected")
    handled = HANDLED_BY_ABI[min(abi, 5)]
    attributes = struct.pack("=QQQ", handled, NETWORK if abi >= 4 else 0, SCOPED if abi >= 6 else 0)
    size = 8 if abi < 4 else 16 if abi < 6 else 24
    ruleset = _must(libc.syscall(CREATE_RULESET, attributes, size, 0), "Landlock's rules")
    try:
        for path in readable:
            _allow(ruleset, path, (READ_FILE | READ_DIR) & handled)
        for path in listable:
            _allow(ruleset, path, READ_DIR)
        _allow(ruleset, Path("/dev/null"), READ_FILE | WRITE_FILE)
        _allow(ruleset, own_folder, (READ_FILE | READ_DIR | WRITE_FILE | REMOVE_FILE | MAKE_REG | TRUNCATE) & handled)
        _must(libc.syscall(RESTRICT_SELF, ruleset, 0), "Landlock")
    finally:
        os.close(ruleset)


def _allow(ruleset: int, path: Path, rights: int) -> None:
    """Allow rights at a path and beneath; what is not there is left out."""
    try:
        place = os.open(path, os.O_PATH | os.O_CLOEXEC)
    except OSError:
        return
    try:
        rights = rights if Path(path).is_dir() else rights & OF_FILES
        _must(
            _libc().syscall(ADD_RULE, ruleset, PATH_BENEATH, struct.pack("=Qi", rights, place), 0), f"rule for {path}"
        )
    finally:
        os.close(place)


# System calls: seccomp. Numbers from 424 on are the same on every machine.

EVERYWHERE = {
    "pidfd_send_signal": 424,
    "io_uring_setup": 425,
    "io_uring_enter": 426,
    "io_uring_register": 427,
    "open_tree": 428,
    "move_mount": 429,
    "fsopen": 430,
    "fsconfig": 431,
    "fsmount": 432,
    "fspick": 433,
    "pidfd_open": 434,
    "pidfd_getfd": 438,
    "process_madvise": 440,
    "mount_setattr": 442,
    "memfd_secret": 447,
    "process_mrelease": 448,
    "fchmodat2": 452,
    "setxattrat": 463,
    "removexattrat": 466,
    "file_setattr": 469,
}
# fmt: off
REFUSED = {
    "x86_64": {
        # the network
        "socket": 41, "connect": 42, "accept": 43, "bind": 49, "listen": 50, "accept4": 288,
        # other processes
        "fork": 57, "vfork": 58, "execve": 59, "execveat": 322, "ptrace": 101, "tkill": 200, "rt_sigqueueinfo": 129,
        "rt_tgsigqueueinfo": 297, "process_vm_readv": 310, "process_vm_writev": 311, "kcmp": 312, "setpriority": 141,
        "sched_setparam": 142, "sched_setscheduler": 144, "sched_setaffinity": 203, "sched_setattr": 314,
        "ioprio_set": 251,
        # files: what Landlock does not look at
        "truncate": 76, "chmod": 90, "fchmod": 91, "chown": 92, "fchown": 93, "lchown": 94, "fchownat": 260,
        "fchmodat": 268, "utime": 132, "utimes": 235, "futimesat": 261, "utimensat": 280, "setxattr": 188,
        "lsetxattr": 189, "fsetxattr": 190, "removexattr": 197, "lremovexattr": 198, "fremovexattr": 199,
        "name_to_handle_at": 303, "open_by_handle_at": 304,
        # memory that no limit counts
        "memfd_create": 319, "shmget": 29, "semget": 64, "msgget": 68, "mq_open": 240, "mq_unlink": 241,
        "add_key": 248, "request_key": 249, "keyctl": 250,
        # the system itself
        "personality": 135, "pivot_root": 155, "chroot": 161, "acct": 163, "settimeofday": 164, "mount": 165,
        "umount2": 166, "swapon": 167, "reboot": 169, "init_module": 175, "delete_module": 176, "quotactl": 179,
        "unshare": 272, "setns": 308, "perf_event_open": 298, "fanotify_init": 300, "finit_module": 313,
        "kexec_file_load": 320, "bpf": 321, "userfaultfd": 323,
    },
    "aarch64": {
        "socket": 198, "bind": 200, "listen": 201, "accept": 202, "connect": 203, "accept4": 242,
        "execve": 221, "execveat": 281, "ptrace": 117, "tkill": 130, "rt_sigqueueinfo": 138,
        "rt_tgsigqueueinfo": 240, "process_vm_readv": 270, "process_vm_writev": 271, "kcmp": 272, "setpriority": 140,
        "sched_setparam": 118, "sched_setscheduler": 119, "sched_setaffinity": 122, "sched_setattr": 274,
        "ioprio_set": 30,
        "truncate": 45, "fchmod": 52, "fchmodat": 53, "fchownat": 54, "fchown": 55, "utimensat": 88, "setxattr": 5,
        "lsetxattr": 6, "fsetxattr": 7, "removexattr": 14, "lremovexattr": 15, "fremovexattr": 16,
        "name_to_handle_at": 264, "open_by_handle_at": 265,
        "memfd_create": 279, "shmget": 194, "semget": 190, "msgget": 186, "mq_open": 180, "mq_unlink": 181,
        "add_key": 217, "request_key": 218, "keyctl": 219,
        "umount2": 39, "mount": 40, "pivot_root": 41, "chroot": 51, "acct": 89, "personality": 92, "unshare": 97,
        "init_module": 105, "delete_module": 106, "reboot": 142, "settimeofday": 170, "swapon": 224,
        "perf_event_open": 241, "fanotify_init": 262, "setns": 268, "finit_module": 273, "bpf": 280,
        "userfaultfd": 282,
    },
}
LOOKED_AT = {  # calls that one argument decides on
    "x86_64": {"open": 2, "openat": 257, "clone": 56, "kill": 62, "tgkill": 234, "prctl": 157, "prlimit64": 302},
    "aarch64": {"openat": 56, "clone": 220, "kill": 129, "tgkill": 131, "prctl": 167, "prlimit64": 261},
}
# fmt: on
ARCHITECTURE = {"x86_64": 0xC000003E, "aarch64": 0xC00000B7}  # AUDIT_ARCH_*
X32 = 0x40000000  # a second table of calls on x86_64
CLONE3, OPENAT2 = 435, 437  # answered as an old kernel would: their arguments cannot be looked at
CLONE_THREAD = 0x00010000
PR_SET_PDEATHSIG = 1

ALLOW, ERRNO, KILL_PROCESS = 0x7FFF0000, 0x00050000, 0x80000000
EPERM, ENOSYS = 1, 38
LOAD, EQUAL, AT_LEAST, HAS_BITS, AND, RETURN = 0x20, 0x15, 0x35, 0x45, 0x54, 0x06  # BPF_LD|W|ABS, BPF_JMP|..., ...


def limit_system_calls() -> None:
    """No socket, no other program or process, no signal to others, no right, owner or time of a file changed."""
    machine = platform.machine()
    if sys.platform != "linux" or machine not in REFUSED:
        raise ConfinementError(f"seccomp on {machine or 'this machine'} is not known here: the network is not closed")
    program = b"".join(_filter(machine, os.getpid()))
    buffer = ctypes.create_string_buffer(program, len(program))
    address = struct.pack("@HP", len(program) // 8, ctypes.addressof(buffer))  # struct sock_fprog
    _must(_libc().prctl(22, 2, ctypes.create_string_buffer(address), 0, 0), "seccomp")  # PR_SET_SECCOMP, MODE_FILTER


def _filter(machine: str, process: int) -> list[bytes]:
    """The filter's instructions: one call after the other, each with its own end."""

    def instruction(code: int, value: int, if_true: int = 0, if_false: int = 0) -> bytes:
        return struct.pack("=HBBI", code, if_true, if_false, value)

    def end(action: int) -> bytes:
        return instruction(RETURN, action)

    def argument(index: int) -> bytes:
        return instruction(LOAD, 16 + 8 * index)  # the low half, on little-endian machines

    refuse, absent = end(ERRNO | EPERM), end(ERRNO | ENOSYS)

    def only(number: int, *decision: bytes) -> list[bytes]:
        return [instruction(EQUAL, number, 0, len(decision)), *decision]

    numbers = LOOKED_AT[machine]
    program = [
        instruction(LOAD, 4),
        instruction(EQUAL, ARCHITECTURE[machine], 1, 0),
        end(KILL_PROCESS),
        instruction(LOAD, 0),
        instruction(AT_LEAST, X32, 0, 1),
        refuse,
    ]
    for number in (*REFUSED[machine].values(), *EVERYWHERE.values()):
        program += only(number, refuse)
    for number in (CLONE3, OPENAT2):
        program += only(number, absent)
    program += only(numbers["clone"], argument(0), instruction(HAS_BITS, CLONE_THREAD, 0, 1), end(ALLOW), refuse)
    for name in ("kill", "tgkill"):
        program += only(numbers[name], argument(0), instruction(EQUAL, process, 0, 1), end(ALLOW), refuse)
    program += only(
        numbers["prlimit64"],
        argument(0),
        instruction(EQUAL, 0, 1, 0),
        instruction(EQUAL, process, 0, 1),
        end(ALLOW),
        refuse,
    )
    program += only(numbers["prctl"], argument(0), instruction(EQUAL, PR_SET_PDEATHSIG, 0, 1), refuse, end(ALLOW))
    # Opened for reading alone and emptied all the same: Landlock looks at that from ABI 3 on only.
    emptied = os.O_TRUNC | os.O_ACCMODE
    for name, index in (("open", 1), ("openat", 2)):
        if name in numbers:
            program += only(
                numbers[name],
                argument(index),
                instruction(AND, emptied),
                instruction(EQUAL, os.O_TRUNC, 0, 1),
                refuse,
                end(ALLOW),
            )
    return [*program, end(ALLOW)]


def die_with_parent() -> None:
    """The kernel kills this process as soon as its parent ends, however that ends."""
    _must(_libc().prctl(PR_SET_PDEATHSIG, 9, 0, 0, 0), "the signal of the parent's death")


def _libc() -> ctypes.CDLL:
    libc = ctypes.CDLL(None, use_errno=True)
    libc.syscall.restype = ctypes.c_long
    return libc


def _must(result: int, what: str) -> int:
    """The result of a call of the C library. Raises `ConfinementError` where it failed."""
    if result < 0:
        number = ctypes.get_errno()
        raise ConfinementError(number, f"{what}: {os.strerror(number)}")
    return result
