// Firefox and WebKit by WebDriver, with those methods of Playwright's page that the tests use.
// Playwright itself drives only its own builds of these engines.

import { Builder, By, Capabilities, until } from "selenium-webdriver";
import { DriverService } from "selenium-webdriver/remote/index.js";

const ENGINES = {
  firefox: {
    program: "geckodriver",
    capabilities: {
      browserName: "firefox",
      "moz:firefoxOptions": { binary: "/usr/bin/firefox-esr" },
    },
  },
  webkit: {
    program: "WebKitWebDriver",
    capabilities: {
      browserName: "MiniBrowser",
      "webkitgtk:browserOptions": {
        binary: "/usr/lib/x86_64-linux-gnu/webkit2gtk-4.1/MiniBrowser",
        args: ["--automation"],
      },
    },
  },
};

/** WebDriver's codes. */
const KEYS = { ArrowLeft: "\uE012", ArrowRight: "\uE014", Space: " " };

/** Starts an engine, which has one page. */
export async function launch(engine) {
  const { program, capabilities } = ENGINES[engine];
  const service = new DriverService.Builder(program).setLoopback(true).build();
  const builder = new Builder().usingServer(await service.start());
  const driver = await builder.withCapabilities(new Capabilities(capabilities)).build();
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
    driver.executeScript(`return (${code})(arguments[0])`, argument);
  const setValue = (selector, value) =>
    evaluate(([selector, value]) => {
      const input = document.querySelector(selector);
      input.focus();
      input.value = value;
      input.dispatchEvent(new Event("input", { bubbles: true }));
      input.dispatchEvent(new Event("change", { bubbles: true }));
    }, [selector, value]);
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
    focus: (selector) => evaluate((selector) => document.querySelector(selector).focus(), selector),
    evaluate,
    textContent: async (selector) => (await find(selector)).getProperty("textContent"),
    inputValue: async (selector) => (await find(selector)).getProperty("value"),
    getAttribute: async (selector, name) => (await find(selector)).getDomAttribute(name),
    waitForSelector: (selector) => driver.wait(until.elementLocated(By.css(selector)), 30_000),
    waitForFunction: (code, argument) =>
      driver.wait(() => evaluate(code, argument), 30_000, String(code)),
    waitForTimeout: (time) => driver.sleep(time),
    setInputFiles: async (selector, path) => (await find(selector)).sendKeys(path),
    keyboard: {
      down: (name) => driver.actions().keyDown(key(name)).perform(),
      up: (name) => driver.actions().keyUp(key(name)).perform(),
      press: (name) => driver.actions().keyDown(key(name)).keyUp(key(name)).perform(),
    },
    /** Clicks a button, and returns the bytes that it downloads. */
    download: async (button) => {
      await evaluate(() => {
        URL.createObjectURL = (blob) => (window.downloaded = blob);
        HTMLAnchorElement.prototype.click = () => {};
      });
      await (await find(button)).click();
      return evaluate(async () => [...new Uint8Array(await window.downloaded.arrayBuffer())]);
    },
  };
}
