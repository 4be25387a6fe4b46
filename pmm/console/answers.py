"""The operator's answers, given in the browser."""


class BrowserAnswers:
    """Keeps the question that the rig asks until somebody answers it.

    Attributes
    ----------
    question
        What waits for an answer; empty if nothing does.
    """

    def __init__(self) -> None:
        self.question = ""
        self._asked = ""
        self._answer: tuple[str, str] | None = None

    def __call__(self, question: str) -> str | None:
        """Return the answer, once there is one."""
        self._asked = str(question)
        answer, self._answer = self._answer, None
        return answer[1] if answer is not None and answer[0] == self._asked else None

    def give(self, question: str, answer: str) -> bool:
        """Answer; tell whether this question was being asked."""
        if not self.question or question != self.question:
            return False
        self._answer = (question, answer.strip())
        return True

    def settle(self) -> None:
        """End a cycle: what was not asked in it is no question any more."""
        self.question, self._asked = self._asked, ""
