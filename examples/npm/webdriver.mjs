// Firefox and WebKit by WebDriver, with those methods of Playwright's page that the tests use.
// Playwright itself drives only its own builds of these engines.

import { Builder, By, Capabilities, until } from "selenium-webdriver";
import { DriverService } from "selenium-webdriver/remote/index.js";

const ENGINES = {
  firefox: {
    program: "geckodriver",
    capabilities: { browserName: "firefox", "moz:firefoxOptions": { binary: "/usr/bin/firefox-esr" } },
  },
  webkit: {
    program: "WebKitWebDriver",
    capabilities: {
      browserName: "MiniBrowser",
      "webkitgtk:browserOptions": { binary: "/usr/lib/x86_64-linux-gnu/webkit2gtk-4.1/MiniBrowser", args: ["--automation"] },
    },
  },
};

/** WebDriver's codes. */
const KEYS = { ArrowLeft: "\uE012", ArrowRight: "\uE014", Space: " " };

/** Starts an engine, which has one page. */
export async function launch(engine) {
  const { program, capabilities } = ENGINES[engine];
  const service = new DriverService.Builder(program).setLoopback(true).build();
  const driver = await new Builder().usingServer(await service.start()).withCapabilities(new Capabilities(capabilities)).build();
  await driver.manage().setTimeouts({ script: 30_000 });
  const close = async () => {
    await driver.quit();
    await service.kill();
  };
  return { newPage: () => page(driver), close };
}

function page(driver) {
  const find = (selector) => driver.findElement(By.css(selector));
  const evaluate = (code, argument) =>
    driver.executeScript(`return ${typeof code === "function" ? `(${code})(arguments[0])` : `(() => { ${code} })()`}`, argument);
  const property = (selector, name) => driver.executeScript("return document.querySelector(arguments[0])[arguments[1]]", selector, name);
  const setValue = async (selector, value) => {
    const input = await find(selector);
    const set = `const [input, value] = arguments; input.focus(); input.value = value;
      for (const name of ["input", "change"]) input.dispatchEvent(new Event(name, { bubbles: true }));`;
    await driver.executeScript(set, input, value);
  };
  const key = (name) => KEYS[name] ?? name;
  return {
    goto: async (url) => {
      await driver.get("about:blank"); // a change of the hash alone loads nothing
      await driver.get(url);
    },
    url: () => driver.getCurrentUrl(),
    click: async (selector) => (await find(selector)).click(),
    fill: setValue,
    selectOption: setValue,
    focus: (selector) => driver.executeScript("document.querySelector(arguments[0]).focus()", selector),
    evaluate,
    textContent: (selector) => property(selector, "textContent"),
    inputValue: (selector) => property(selector, "value"),
    getAttribute: (selector, name) =>
      driver.executeScript("return document.querySelector(arguments[0]).getAttribute(arguments[1])", selector, name),
    waitForSelector: (selector) => driver.wait(until.elementLocated(By.css(selector)), 30_000),
    waitForFunction: (code, argument) => driver.wait(() => evaluate(code, argument), 30_000, String(code)),
    waitForTimeout: (time) => driver.sleep(time),
    setInputFiles: async (selector, path) => (await find(selector)).sendKeys(path),
    locator: (selector) => ({
      fill: (value) => setValue(selector, value),
      allTextContents: () => evaluate("return [...document.querySelectorAll(" + JSON.stringify(selector) + ")].map((each) => each.textContent)"),
    }),
    keyboard: {
      down: (name) => driver.actions().keyDown(key(name)).perform(),
      up: (name) => driver.actions().keyUp(key(name)).perform(),
      press: (name) => driver.actions().keyDown(key(name)).keyUp(key(name)).perform(),
    },
    /** Clicks a button, and returns the bytes that it downloads. */
    download: async (button) => {
      await driver.executeScript(`
        const { createObjectURL } = URL;
        const { click } = HTMLAnchorElement.prototype;
        URL.createObjectURL = (blob) => createObjectURL((window.downloaded = blob));
        HTMLAnchorElement.prototype.click = () => {
          URL.createObjectURL = createObjectURL;
          HTMLAnchorElement.prototype.click = click;
        };`);
      await (await find(button)).click();
      return driver.executeScript("return window.downloaded.arrayBuffer().then((bytes) => [...new Uint8Array(bytes)])");
    },
  };
}
