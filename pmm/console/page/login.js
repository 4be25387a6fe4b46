// Asks for the token and goes to the console with the cookie that it buys.
const said = document.getElementById("login-said");
document.getElementById("login").addEventListener("submit", async (event) => {
  event.preventDefault();
  const token = document.getElementById("token").value;
  const answer = await fetch("/login", {
    method: "POST",
    headers: { "content-type": "application/json" },
    body: JSON.stringify({ token, name: document.getElementById("name").value }),
  });
  if (answer.ok) location.assign("/");
  else said.textContent = (await answer.json()).error;
});
