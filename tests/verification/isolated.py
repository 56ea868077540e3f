"""A run in a process of its own, which may crash or hang without harm to what started it."""

import multiprocessing


def in_a_process(wall_bound, function, *arguments):
    """("finished", what function returned), ("hung", reason) or ("crashed", reason). It starts with nothing of an earlier run's."""
    receiver, sender = multiprocessing.Pipe(duplex=False)
    process = multiprocessing.Process(target=lambda: sender.send(function(*arguments)))
    process.start()
    sender.close()
    try:
        if receiver.poll(wall_bound):
            return "finished", receiver.recv()
        return "hung", f"not done in {wall_bound:g} s"
    except EOFError:
        process.join()
        return "crashed", f"the process ended with {process.exitcode}"
    finally:
        process.kill()
        process.join()
