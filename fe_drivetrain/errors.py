"""The one exception for what a user can mend."""


class InputError(Exception):
    """A user's mistake: bad scene, bad file, bad option.

    The message is one sentence that names the object, the value, the allowed range and the mend.
    The command line prints it without a traceback and exits with status 2.
    """


class MissingToolError(InputError):
    """Something optional that a case needs is not installed; the message says how to get it."""


SINGULAR = "the stiffness matrix is singular: the scene is not held everywhere"
